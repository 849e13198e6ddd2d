#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Which tests find that a rule of event location (docs/numerics.md, Events) is left out? For each mutation one header
is changed, and the tests run that are compiled with it: C++ programs of a build folder, Python tests of a package.

Usage: event_rules.py [--build DIR] [--site DIR] [--only NAME,...] [--jobs N] [--seconds S] [--python PROGRAM]
       event_rules.py --check
`--build` is a folder of CMake's with Ninja in which the programs are built. `--site` holds an installed myriad_ode of
this tree. `--check` only shows that each text stands in its header exactly once. Exit status 1 if a mutation was not
found, or a text is not there.
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
# In order of their cost: the first failure ends the search.
TESTS = ["test_event_rules.py",
         "test_random_events.py::test_a_flat_event_function_is_located_to_the_resolution_of_time",
         "test_random_events.py::test_a_state_that_an_action_moves_onto_the_surface_of_another_event_does_not_cross_it"]
PROGRAMS = ["event_test", "metamorphic_test"]

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
    "no_least_rounding": ("event_functions.hpp", "constexpr R least = smallest_normal_of<R> / epsilon_of<R>;",
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
    "coarse_roundings_at_start": ("locator.hpp", "plain = plain && tolerance > R(0) && (near ||",
                                  "plain = plain && (near ||", "without a tolerance, rounding decides"),
    "others_pass_plainly": ("locator.hpp", "left && (is_target || !own.redo.crossed[j])", "left",
                            "others that crossed are looked at"),
    "plain_first_within_tolerance": ("locator.hpp", "further = redo.improve(step.h, guess, before);", "",
                                     "a step within the tolerance given is improved"),
    "guesses_trusted": ("redone_step.hpp", "return tries < most_guesses && !is_between(h);", "return true;",
                        "a jump is located by bisection"),
    # Together, each once
    "alone": ("general_locator.hpp", "redo.target == j || (redo.crossed[j] && (heads || jumps))", "redo.target == j",
              "functions fire together if their crossings cannot be told apart"),
    "along_without_heading": ("general_locator.hpp", "here[j] && side[j] * heading[j] < R(0)", "here[j]",
                              "what fires along must be on its way across"),
    "jumps_apart": ("general_locator.hpp", "narrow && side[j] * step.g1[j] > band && !here[j]", "false",
                    "functions that jump at one instant fire together"),
    "undecided_left": ("general_locator.hpp", "undecided = undecided || (soon && !here[j]);", "", "the step is redone "
                       "to where others are together with the first"),
    "size_decides": ("event_memory.hpp", "if (!(at->tolerance[j] > place.rounding[j]) && is_short) {", "if (false) {",
                     "the sign a little ahead decides what is here, not the size"),
    "zero_at_end_left_out": ("event_location.hpp", "redo.crossed.set(j, crossed[j] || undecided);",
                             "redo.crossed.set(j, crossed[j]);", "what is zero at a trial's end may cross along"),
    "alone_at_start": ("event_location.hpp", "(again ? crossed[j] : along)", "false",
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
    "hook_moves_nothing": ("side_tracker.hpp", "if (!keeps) sides.put_side(j, i, is_there ? R(0) : sign_of(now));", "",
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
    "no_samples": ("step_scan.hpp", "while (at->points < sides.args.sub_samples)", "while (at->points < 1)",
                   "points inside the step are looked at"),
}


def stale_mutations():
    """Messages about mutations whose text does not stand in its header exactly once, and tests that are not there."""
    stale = headers.stale(MUTATIONS, ROOT / HEADERS)
    for file, _, test in (test.partition("::") for test in TESTS):
        if test and f"def {test}(" not in (ROOT / "python/tests" / file).read_text():
            stale.append(f"there is no test {test} in {file}")
    return stale


class CompiledPrograms:
    """C++ test programs of a build folder, whose objects are compiled anew with a changed header."""

    def __init__(self, build):
        self.build = build
        self.commands = {}
        for program in PROGRAMS:
            *compilations, link = re.sub(r" -include \S*cmake_pch.hxx", "",
                                         self.ninja("commands", f"tests/{program}")).splitlines()
            own = {re.search(r" -o (\S+\.o) ", line)[1]: line for line in compilations if f"/{program}.dir/" in line}
            changed = {path: line for path, line in own.items() if HEADERS in self.ninja("deps", path)}
            if not changed:
                sys.exit(f"{program} is not built in {build}, or without {HEADERS}.")
            self.commands[program] = (changed, link)

    def ninja(self, tool, target):
        return subprocess.run(["ninja", "-C", self.build, "-t", tool, target], capture_output=True, text=True,
                              check=True).stdout

    def first_failure(self, mutation, work, options):
        overlay = work / "overlay/myriad/kernel/event"
        overlay.mkdir(parents=True)
        shutil.copy(ROOT / HEADERS / mutation[0], overlay)
        headers.change(mutation, overlay)
        for program, (compilations, link) in self.commands.items():
            for path, line in compilations.items():
                before, compiler, arguments = re.fullmatch(r"((?:\S*ccache )?)(\S+) (.*)", line).groups()
                made = work / path.replace("/", "_")
                self.shell(f"{before}{compiler} -I{work / 'overlay'} {arguments} -w".replace(f" {path}", f" {made}"))
                link = link.replace(f" {path}", f" {made}")
            self.shell(re.sub(r" -o \S+", f" -o {work / program}", link))
            done = run([str(work / program)], options, cwd=self.build)
            if isinstance(done, str) or done.returncode:
                return f"{program}{f', {done}' if isinstance(done, str) else ''}"
        return None

    def shell(self, command):
        done = subprocess.run(command, shell=True, capture_output=True, text=True, cwd=self.build)
        if done.returncode:
            sys.exit(f"{command}\n{done.stderr[-3000:]}")


class Package:
    """Python tests of an installed package, whose models are compiled with a changed header."""

    def __init__(self, site):
        self.site = site

    def first_failure(self, mutation, work, options):
        site = work / "site"
        shutil.copytree(self.site, site, copy_function=os.link)
        folder = site / "myriad_ode" / HEADERS
        (folder / mutation[0]).unlink()
        shutil.copy(ROOT / HEADERS / mutation[0], folder)
        headers.change(mutation, folder)
        command = [options.python, "-m", "pytest", "-q", "-x", "-p", "no:cacheprovider", "--tb=line"]
        command += [str(ROOT / "python/tests" / test) for test in TESTS]
        folders = os.pathsep.join(filter(None, [str(site), os.environ.get("PYTHONPATH")]))
        done = run(command, options, cwd=work, env={**os.environ, "PYTHONPATH": folders, "MYRIAD_TEST_COMPILED": "1",
                                                    "PYTHONDONTWRITEBYTECODE": "1"})
        if isinstance(done, str) or done.returncode == 0:
            return done if isinstance(done, str) else None
        failed = re.search(r"^(?:FAILED|ERROR) \S*?([^/\s]+::.*)$", done.stdout, re.MULTILINE)
        if failed is None or "the model does not compile" in done.stdout:
            sys.exit(f"The tests did not run:\n{done.stdout[-3000:]}{done.stderr[-1000:]}")
        return failed[1][:200]


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
    parser.add_argument("--site", type=pathlib.Path, help="a folder with an installed package")
    parser.add_argument("--only", help="names of mutations")
    parser.add_argument("--jobs", type=int, default=1, help="mutations at a time")
    parser.add_argument("--seconds", type=float, default=1500, help="after which a test's run counts as without end")
    parser.add_argument("--work", help="a folder for temporary files, on the file system of --site")
    parser.add_argument("--python", default=sys.executable)
    options = parser.parse_args()
    stale = stale_mutations()
    if stale:
        parser.exit(1, "\n".join(["Mend these mutations:"] + stale) + "\n")
    if options.check:
        return 0
    names = options.only.split(",") if options.only else list(MUTATIONS)
    unknown = [name for name in names if name not in MUTATIONS]
    if unknown or not (options.build or options.site):
        parser.error(f"there is no mutation {unknown[0]}" if unknown else "give --build or --site")
    tests = [CompiledPrograms(options.build.resolve())] if options.build else []
    tests += [Package(options.site.resolve())] if options.site else []
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        missed = list(pool.map(lambda name: verdict(name, tests, options), names)).count(False)
    print(f"{len(names)} mutations, {missed} not found")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
