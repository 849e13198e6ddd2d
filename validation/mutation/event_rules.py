#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Which tests find that a rule of event location (docs/numerics/events.md) is left out? For each mutation one header
is changed, and what is compiled with it is built and tested: C++ programs, and the interpreter of the Python package,
in packs and then in single lanes, as on GPUs.

Usage: event_rules.py [--build DIR] [--package DIR] [--only NAME,...] [--jobs N] [--seconds S] [--python PROGRAM]
       event_rules.py --check
`--build` is a folder of CMake's with Ninja in which the programs are built, `--package` one in which the package is
(that in build/python, made by scripts/python.sh). `--check` only shows that each text stands in its header exactly
once. Exit status 1 if a mutation was not found, or a text is not there.
"""
import argparse
import concurrent.futures
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import headers

ROOT = pathlib.Path(__file__).resolve().parents[2]
HEADERS = "include/myriad/kernel/event"
PROGRAMS = ["parts_test", "event_test", "metamorphic_test"]
TESTS = ["test_event_rules.py", "test_metamorphic_events.py", "test_random_events.py"]

# name: (header, text, replacement, the rule that it leaves out)
MUTATIONS = {
    # The side is the sign; crossings are changes of side.
    "zero_changes_side": ("detector.hpp", "crossed[j] & (detected.g1[j] != S(R(0)))", "crossed[j]",
                          "zero belongs to either side"),
    "any_direction": ("lane_sides.hpp", "return is_asked(j, side) && side * g < -past;", "return side * g < -past;",
                      "a crossing in another direction is no event"),
    "rounding_crosses": ("general_locator.hpp", "const R past = signs_tell ? near.allowances[j] : near.past(j);",
                         "const R past = near.allowances[j];", "past zero by its rounding error is no crossing"),
    "sides_kept_after_trial": ("side_resolver.hpp",
                               "abs(step.g1[j]) > own.near.past(j) ? sign_of(step.g1[j]) : side[j]", "side[j]",
                               "after a trial the side is the sign"),
    "no_least_rounding": ("event_functions.hpp", "constexpr R least = R(256) * smallest_normal_of<R>;",
                          "constexpr R least = R(0);", "denormal states have a rounding error"),
    "equal_weights": ("event_functions.hpp", "static_cast<R>(1 + (turns - static_cast<double>("
                      "static_cast<long long>(turns))))", "static_cast<R>(1 + 0 * turns)",
                      "x - y has a rounding error though its terms cancel"),
    "infinite_rounding": ("event_functions.hpp", "rounding[j] = change < infinity_of<R> ? R(8)",
                          "rounding[j] = true ? R(8)", "a slope that is not finite gives no rounding error"),
    "rounding_of_the_sum": ("step_ends.hpp", "max(abs(y[c]), abs(y1[c])) + abs(h * slope[c])", "abs(y1[c])",
                            "a state has the rounding errors of what it is the sum of"),
    # Location
    "located_to_tolerance": ("redone_step.hpp", "tries >= most_guesses && tolerance[j] <= rounding", "false",
                             "without a tolerance, signs decide once guesses fail"),
    "tolerance_of_any_size": ("event_location.hpp", "min(args.event[j].tolerance, R(largest_part) * change)",
                              "args.event[j].tolerance", "a tolerance counts as a 64th of the change at most"),
    "no_approach_by_1024": ("redone_step.hpp", "before == R(0) ? R(1.0 / 1024) * h : R(0.5)", "before == R(0) ? R(0.5)"
                            " * h : R(0.5)", "the first bracket shrinks by 1024"),
    "guesses_for_ever": ("redone_step.hpp", "length = tries < most_guesses && is_inside(guess, h) ? guess : middle;",
                         "length = is_inside(guess, h) ? guess : middle;", "bisection after ten trials"),
    "first_within_tolerance": ("general_locator.hpp", "redo.improve(step.h, guess, reached.gap > R(0))", "false",
                               "a step within the tolerance is improved"),
    "started_at_the_secant": ("crossing.hpp", "if (b >= R(0)) x = max(", "if (false) x = max(",
                              "from where a function rises, the guess is its return"),
    "crosses_at_start": ("earliest_crossing.hpp", "if (!(g.value > R(0)) && (g.slope < R(0) || (left && g.slope == "
                         "R(0)))) return R(0);", "", "a function past zero at the start that goes on crosses there"),
    "last_of_events": ("earliest_crossing.hpp", "if (x < first.fraction) first", "if (x > first.fraction || "
                       "first.fraction > R(1)) first", "the earliest crossing is located first"),
    "coarse_roundings_at_start": ("locator.hpp", "plain = plain & (tolerance > R(0)) & (near |",
                                  "plain = plain & (near |", "without a tolerance, rounding decides"),
    "others_pass_plainly": ("locator.hpp", "left & (is_target | !crossed_before[j])", "left",
                            "others that crossed are looked at"),
    "plain_first_within_tolerance": ("locator.hpp", "further = redo.improve(step.h, guess, before);", "",
                                     "a step within the tolerance given is improved"),
    "guesses_trusted": ("redone_step.hpp", "return tries < most_guesses && !is_between(h);", "return true;",
                        "a jump is located by bisection"),
    # Together, each once
    "alone": ("general_locator.hpp", "redo.target == j || (redo.crossed[j] && (heads || between))", "redo.target == j",
              "functions fire together if their crossings cannot be told apart"),
    "along_without_heading": ("general_locator.hpp", "here[j] && side[j] * heading[j] < R(0)", "here[j]",
                              "what fires along must be on its way across"),
    "jumps_apart": ("general_locator.hpp", "narrow && redo.changed[j]", "false",
                    "functions that change sign within one rounding of time fire together"),
    "not_within_tolerances": ("event_memory.hpp", "max(place.length, place.first)", "place.length",
                              "what crosses where another within its tolerance is zero crosses with it"),
    "size_decides": ("event_memory.hpp", "if (place.length * R(64) <= abs(place.t) + abs(place.h) &&", "if (false &&",
                     "the sign a little ahead decides what is here, not the size"),
    "zero_at_end_left_out": ("event_location.hpp", "redo.crossed.set(j, crossed[j] || may_cross);",
                             "redo.crossed.set(j, crossed[j]);", "what is zero at a trial's end may cross along"),
    "later_forgotten": ("event_location.hpp", "bool may_cross = again && redo.crossed[j];", "bool may_cross = false;",
                        "what crosses a little later may cross along"),
    "alone_at_start": ("event_location.hpp", "(again ? redo.changed[j] : along)", "false",
                       "at the start of a step, too, functions fire together"),
    "end_of_phase_forgotten": ("side_tracker.hpp", "own.fresh = own.fresh | which;", "",
                      "a phase keeps that an event fired where it ended"),
    # After actions
    "sign_not_taken": ("side_resolver.hpp", "if (moved && beyond) side = sign_of(g[j]);", "",
                       "after an action the side is the sign"),
    "never_crosses": ("side_resolver.hpp", "side = acted || rests ? from : -from;", "side = from;",
                      "a flat function that no action changed has crossed"),
    "rest_crosses": ("side_resolver.hpp", "side = acted || rests ? from : -from;", "side = -from;",
                     "a function at rest keeps the side it came from"),
    "no_residual": ("side_resolver.hpp", "fires && !jumps ? max(located, abs(slope[j]) * location_error) : R(0)",
                    "R(0)", "an action that hardly moves its function leaves it on the surface"),
    "no_time_residual": ("side_resolver.hpp", "max(located, abs(slope[j]) * location_error)", "located",
                         "so near that it gets there within the error of location is on the surface"),
    "tolerance_unbounded": ("side_resolver.hpp", "const R located = min(R(2) * abs(get_lane(events.value[j], i)), "
                            "sides.args.event[j].tolerance);", "const R located = sides.args.event[j].tolerance;",
                            "on the surface is no more than twice as far as located"),
    "moved_onto_others": ("side_resolver.hpp", "moved_near[j] && abs(g[j]) <= abs(slope[j]) * error", "false",
                          "moved onto another's surface is beside it by the location's error"),
    "coarse_time_error": ("side_resolver.hpp", "return min(error, most);", "return most;",
                          "the location's error is what the event was located with"),
    "jump_not_passed": ("side_resolver.hpp", "if (g[j] * there[j] < R(0)) {", "if (false) {",
                        "right before a jump the values ahead decide"),
    "jump_time": ("side_resolver.hpp", "sides.memory_of(i).jump_time = time_to_pass(i, slope, there);",
                  "sides.memory_of(i).jump_time = R(0);", "what fired at a jump is not tested until it is passed"),
    # Open and kept sides
    "held_side_lost": ("side_resolver.hpp", "held[j] && !turns ? (", "false ? (", "the side that a phase kept stands"),
    "no_turn_between_phases": ("side_resolver.hpp", "fired_last[j] && abs(slope[j] * step.h) > rounding[j]", "false",
                               "the host may turn the flow round between phases"),
    "flat_heading": ("event_functions.hpp", "return abs(slope) > R(0) && abs(slope) < infinity_of<R>;", "return true;",
                     "where the slope does not tell, the first signs ahead do"),
    "hook_moves_nothing": ("side_tracker.hpp", "sides.put_side(j, i, is_there ? R(0) : sign_of(now));", "",
                           "a function that a hook moved is on the side where it is"),
    "hook_keeps_surface": ("side_tracker.hpp", "is_there ? R(0) : sign_of(now)", "sign_of(now)",
                           "one that a hook puts on the surface has an open side"),
    "timeless_leaves": ("lane_sides.hpp", "return abs(length) <= rounding_of_time(i);", "return false;",
                        "values within four roundings of t after an event do not count as leaving"),
    "lingers_for_ever": ("event_driver.hpp", "e_.left.get(j, i) ? 1 : lingered + 1", "1", "actions that do not leave "
                         "the surface are counted"),
    "crosses_before_it_left": ("general_locator.hpp", "!e.left.get(j, i) && side[j] * heading[j] > R(0);",
                               "!e.left.get(j, i) && side[j] * heading[j] > R(0) && reached.gap >= R(0);",
                               "what returns from past its surface has not crossed it"),
    "leaves_at_once": ("general_locator.hpp", "leaves = !reached.all_left && !e.left.get(j, i)",
                       "leaves = false && !e.left.get(j, i)", "a function leaves before it crosses again"),
    # The end of the domain
    "end_only_past_zero": ("general_locator.hpp", "|| side[j] * found.heading[j] <= R(0);", "|| false;",
                           "at the end a function fires if rounding errors keep it from zero"),
    "end_without_sign_beyond": ("general_locator.hpp", " && side[j] * found.place.sign[j] < R(0);", ";",
                                "at the end the first sign beyond must be that of the other side"),
    "end_without_tolerance": ("general_locator.hpp", "const bool happens = reaches && close &&",
                              "const bool happens = reaches &&", "at the end g must be within its tolerance"),
    "end_of_all_steps": ("event_memory.hpp", "iterations - own->moved_at[at->function] +", "iterations +",
                         "steps before an event's last action do not count at the end"),
    "end_of_no_actions": ("event_memory.hpp", "+ steps_of_location * own->moves", "+ 0",
                          "the times of all actions count at the end"),
    "end_on_a_line": ("event_memory.hpp", "place.bend[c] = (step.slope1[c] - step.slope[c]) * per_time",
                      "place.bend[c] = R(0) * per_time", "the path beyond the end is a parabola"),
    # Looks inside steps
    "no_turns": ("step_scan.hpp", "if (at->turns++ < MYRIAD_LENGTH(m)) find_turn(step, side, part.low, at);", "",
                 "with sub_samples, turns are looked at"),
    "turns_on_the_cubic": ("step_scan.hpp", "const bool shortens = is_adaptive<Method> &&",
                           "const bool shortens = false &&", "adaptive steps end where a function turns"),
    "far_turns": ("step_scan.hpp", "if (side[k] * value > R(far_turn) * moves) continue;", "",
                  "turns far from zero end no step"),
    "no_samples": ("step_scan.hpp", "while (at->points < sides.args.sub_samples)", "while (at->points < 1)",
                   "points inside the step are looked at"),
}


def stale_mutations():
    """Messages about mutations whose text does not stand in its header exactly once."""
    return headers.stale(MUTATIONS, ROOT / HEADERS)


def ninja(build, tool, target):
    """The lines that one of Ninja's tools prints."""
    done = subprocess.run(["ninja", "-C", build, "-t", tool, target], capture_output=True, text=True, check=True)
    return done.stdout.splitlines()


def shell(command, folder):
    done = subprocess.run(command, shell=True, capture_output=True, text=True, cwd=folder)
    if done.returncode:
        sys.exit(f"{command}\n{done.stderr[-3000:]}")


class Built:
    """A program or module of a build folder, whose objects are compiled anew with a changed header."""

    def __init__(self, build, target):
        self.build, self.target = build, target
        *compilations, self.link = ninja(build, "commands", target)
        self.changed = {}
        for line in compilations:
            made = re.search(r" -o (\S+\.o) ", line)
            if made and any(HEADERS in source for source in ninja(build, "deps", made[1])):
                self.changed[made[1]] = re.sub(r" -include \S*cmake_pch.hxx", "", line)
        if not self.changed:
            sys.exit(f"{target} is not built in {build}, or without {HEADERS}.")

    def make(self, mutation, work, result, flags=""):
        """Builds it with the mutation, as `result`."""
        overlay = work / "overlay/myriad/kernel/event"
        shutil.copytree(ROOT / HEADERS, overlay, dirs_exist_ok=True)
        headers.change(mutation, overlay)
        link = self.link
        for path, line in self.changed.items():
            before, compiler, arguments = re.fullmatch(r"((?:\S*ccache )?)(\S+) (.*)", line).groups()
            made = work / path.replace("/", "_")
            shell(f"{before}{compiler} -I{work / 'overlay'} {flags} {arguments} -w".replace(f" {path}", f" {made}"),
                  self.build)
            link = link.replace(f" {path}", f" {made}")
        shell(re.sub(r" -o \S+", f" -o {result}", link), self.build)


class CompiledPrograms:
    """C++ test programs."""

    def __init__(self, build):
        self.programs = {name: Built(build, f"tests/{name}") for name in PROGRAMS}

    def first_failure(self, mutation, work, options):
        for name, program in self.programs.items():
            program.make(mutation, work, work / name)
            done = run([str(work / name)], options, cwd=program.build)
            if isinstance(done, str) or done.returncode:
                return f"{name}{f', {done}' if isinstance(done, str) else ''}"
        return None


class Interpreter:
    """Python tests, whose models are interpreted."""

    def __init__(self, build):
        self.build = build
        self.core = Built(build, next(build.glob("_core.*.so")).name)

    def first_failure(self, mutation, work, options):
        package = work / "myriad_ode"
        shutil.copytree(ROOT / "python/myriad_ode", package)
        shell(f"cmake --install . --prefix {work}", self.build)
        for lanes, flags in {"in packs": "", "in single lanes": "-DMYRIAD_SCALAR_LANES"}.items():
            self.core.make(mutation, work, package / self.core.target, flags)
            for arguments in (["-m", "pytest", "-q", "-x", "-p", "no:cacheprovider", "--tb=line",
                               *(str(ROOT / "python/tests" / test) for test in TESTS)],
                              [str(ROOT / "python/tests/test_metamorphic_events.py"), "--random", "1000"]):
                folders = os.pathsep.join(filter(None, [str(work), os.environ.get("PYTHONPATH")]))
                done = run([options.python, *arguments], options, cwd=work,
                           env={**os.environ, "PYTHONPATH": folders, "PYTHONDONTWRITEBYTECODE": "1"})
                if isinstance(done, str):
                    return f"{lanes}, {done}"
                if done.returncode:
                    failed = re.search(r"^(?:FAILED|ERROR) \S*?([^/\s]+::.*)$", done.stdout, re.MULTILINE)
                    if failed is None and "-m" in arguments:
                        sys.exit(f"The tests did not run:\n{done.stdout[-3000:]}{done.stderr[-1000:]}")
                    return f"{lanes}, {failed[1][:200] if failed else 'random cases'}"
        return None


def run(command, options, **how):
    """The finished process, or what made it end."""
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=options.seconds, **how)
    except subprocess.TimeoutExpired:
        return f"no end within {options.seconds} s"
    return f"a crash, signal {-done.returncode}" if done.returncode < 0 else done


def verdict(name, tests, options):
    """Whether the tests find the mutation, and what it says of that."""
    with tempfile.TemporaryDirectory(prefix=f"myriad-{name}-", dir=options.work) as folder:
        found = next(filter(None, (test.first_failure(MUTATIONS[name], pathlib.Path(folder), options)
                                   for test in tests)), None)
    says = "NOT FOUND" if found is None else f"found by {found}"
    print(f"{name} ({MUTATIONS[name][3]}): {says}", flush=True)
    return found is not None


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--check", action="store_true", help="only whether each text stands in its header once")
    parser.add_argument("--build", type=pathlib.Path, help="a build folder with the C++ tests")
    parser.add_argument("--package", type=pathlib.Path, help="a build folder of the Python package")
    parser.add_argument("--only", help="names of mutations")
    parser.add_argument("--jobs", type=int, default=1, help="mutations at a time")
    parser.add_argument("--seconds", type=float, default=1500, help="after which a test's run counts as without end")
    parser.add_argument("--work", help="a folder for temporary files")
    parser.add_argument("--python", default=sys.executable)
    options = parser.parse_args()
    stale = stale_mutations()
    if stale:
        parser.exit(1, "\n".join(["Mend these mutations:"] + stale) + "\n")
    if options.check:
        return 0
    names = options.only.split(",") if options.only else list(MUTATIONS)
    unknown = [name for name in names if name not in MUTATIONS]
    if unknown or not (options.build or options.package):
        parser.error(f"there is no mutation {unknown[0]}" if unknown else "give --build or --package")
    tests = [CompiledPrograms(options.build.resolve())] if options.build else []
    tests += [Interpreter(options.package.resolve())] if options.package else []
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        missed = list(pool.map(lambda name: verdict(name, tests, options), names)).count(False)
    print(f"{len(names)} mutations, {missed} not found")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
