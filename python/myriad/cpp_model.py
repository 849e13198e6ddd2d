# SPDX-License-Identifier: MIT
"""Models that are written in C++ rather than traced."""

from .errors import Error


class CppEvent:
    """The name of an event of a model in C++, and how it is detected unless a call says otherwise."""

    def __init__(self, name, direction="either", tolerance=None, stop_after=0):
        self.name, self.direction, self.tolerance, self.stop_after = name, direction, tolerance, stop_after


def _names(several):
    return tuple(several.replace(",", " ").split() if isinstance(several, str) else several)


class CppModel:
    """A model as a C++ struct, as in the C++ library's documentation: `text` defines the struct `struct`. The other
    arguments name its components in the order of its enumerations, as one string or a list; events may be a dict from
    names to their `direction`, `tolerance` and `stop_after`. `generates` names what the struct's `generate` sets, if a
    study is to call it."""

    def __init__(self, text, struct, states, parameters=(), shared=(), shared_integers=(), accessories=(),
                 integer_accessories=(), events=(), generates=()):
        if struct not in text:
            raise Error(f"the text of the model defines no struct {struct}: give the name of the model's struct")
        self._text, self.name = text, struct
        self.states, self.parameters = _names(states), _names(parameters)
        self.shared, self.shared_integers = _names(shared), _names(shared_integers)
        self.accessories, self.integer_accessories = _names(accessories), _names(integer_accessories)
        options = events if hasattr(events, "items") else dict.fromkeys(_names(events), {})
        self.generated = _names(generates)
        self.generator = f"{struct}::generate" if self.generated else ""
        self.events = tuple(CppEvent(name, **chosen) for name, chosen in options.items())

    def cpp(self):
        """The text of the model."""
        return self._text

    def source(self):
        """The text that kernels are compiled from, and the name of its struct."""
        return self._text, self.name
