#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Shows that the validation detects a wrong loop: copies the headers, changes one line in each copy, compiles the
kernels of one problem with it and runs the validation on them, which must fail; with unchanged headers it must pass on
all these problems.

Usage: logic.py --source DIR --kernels DIR --work DIR --host LIBRARY --compile "COMMAND" --link "ARGUMENTS"
                [--only NAME,...]
Exit status 1 if a changed loop passes, or the unchanged one fails.
"""
import argparse
import concurrent.futures
import math
import os
import pathlib
import resource
import shlex
import shutil
import signal
import subprocess
import sys
import threading

import headers

_upper_solve = """<0, n_state<Model>>([&](auto s) MYRIAD_LAMBDA {
        const auto row = lu_type::template at<&tables::pivot>(s);
        S x = b[row];
        lu_type::template of_step<&tables::upper_begin>("""

# name: (header, text, replacement, the problem that shows it). The text must occur exactly once.
MUTATIONS = {
    "swapped_direction": ("kernel/event/lane_sides.hpp",
                          "args.falling)) | (~above & masks::from_bits(args.rising))",
                          "args.rising)) | (~above & masks::from_bits(args.falling))",
                          "bouncing_ball"),
    "unseen_direction": ("kernel/event/lane_sides.hpp", "(above & masks::from_bits(args.falling))",
                         "(above & masks::from_bits(args.rising))", "bouncing_ball"),
    "lost_action": ("kernel/integrator/hook_driver.hpp",
                    "run_hook(i, [&](auto& lane) MYRIAD_LAMBDA { return Model::after_event(j, lane); });",
                    "static_cast<void>(j);", "bouncing_ball"),
    "stale_slope": ("kernel/integrator/hook_driver.hpp",
                    "s.slopes.invalidate(changed);\n                check_finite",
                    "check_finite", "bouncing_ball"),
    "rejected_step_accepted": ("kernel/controller/adaptive.hpp", "mask accepted = s.running() & within;",
                               "mask accepted = s.running() & valid;", "timed_circle"),
    "error_taken_for_less": ("kernel/controller/norm.hpp", "return abs(error) / scale;",
                             "return abs(error) / scale * S(0.01);", "kepler"),
    "first_slope_for_the_last": ("kernel/state/slope_cache.hpp",
                                 "select(accepted, trial.slope_end()[c], start_[c])",
                                 "select(accepted, trial.k[0][c], start_[c])", "kepler"),
    "stages_at_the_end_of_the_step": ("kernel/stepper/explicit_rk.hpp",
                                      "fma(S(detail::node_operand<Method, stage, R>()), h, t)",
                                      "(t + h)", "timed_circle"),
    "short_last_step": ("kernel/controller/adaptive.hpp", "s.h = select(s.final_step, remaining,",
                        "s.h = select(s.final_step, remaining * S(R(0.999)),", "kepler"),
    "event_not_redone": ("kernel/event/locator.hpp",
                         "{sides.args}, events);\n            return trial_outcome::is_redone;",
                         "{sides.args}, events);", "bouncing_ball"),
    "event_counted_twice": ("kernel/integrator/hook_driver.hpp", "get_lane(s.data.event_count[j], i)) + 1;",
                            "get_lane(s.data.event_count[j], i)) + 2;", "bouncing_ball"),
    "step_other_than_that_of_t": ("kernel/controller/adaptive.hpp", "h = (s.data.t + h) - s.data.t;",
                                  "h = h + R(0) * s.data.t;", "orbit"),
    "weights_rounded_one_by_one": ("kernel/methods/weights.hpp", "sizeof(R) >= sizeof(double)) return rounded;",
                                   "true) return rounded;", "orbit"),
    "entry_left_out_of_the_pattern": ("kernel/scalar/dependence.hpp", "both.on[w] = a.on[w] | b.on[w];",
                                      "both.on[w] = a.on[w] ^ b.on[w];", "hires"),
    "factors_solved_in_another_order": ("kernel/stepper/sparse_lu.hpp",
                                        "range_backwards" + _upper_solve, "range" + _upper_solve, "hires"),
}
DEFAULT = ["swapped_direction", "lost_action", "stale_slope", "rejected_step_accepted",
           "entry_left_out_of_the_pattern", "factors_solved_in_another_order"]
# An endless loop, or one of tiny steps, is detected too: by this many times the CPU time of the unchanged one, and
# after so many seconds at the latest.
MOST_TIMES, SECONDS = 8, 120


def prepare(options, name):
    """The folder with the headers to compile with: a copy with one change."""
    if name is None:
        return options.source / "include"
    folder = options.work / name / "include"
    shutil.rmtree(options.work / name, ignore_errors=True)
    shutil.copytree(options.source / "include", folder)
    headers.change(MUTATIONS[name], folder / "myriad")
    return folder


def build_program(options, name, problems):
    """Builds the validation of some problems; returns what went wrong, or None."""
    include = prepare(options, name)
    build = options.work / (name or "unchanged")
    build.mkdir(parents=True, exist_ok=True)
    objects = []
    for problem in problems:
        objects.append(str(build / f"{problem}.o"))
        # Made from the template, or written by hand.
        candidates = [folder / f"{problem}_kernels.cpp"
                      for folder in (options.kernels, options.source / "validation/problems")]
        kernels = next(path for path in candidates if path.exists())
        command = shlex.split(options.compile) + [
            f"-I{include}", f"-I{options.source}/backends/openmp", f"-I{options.source}",
            "-DMYRIAD_SCALAR_LANES", "-O0", "-c", str(kernels), "-o", objects[-1]]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode != 0:
            return f"{name}: does not compile\n{done.stderr[-2000:]}"
    link = shlex.split(options.compile) + objects + [str(options.host)] + shlex.split(options.link)
    link += ["-o", str(build / "validate")]
    done = subprocess.run(link, capture_output=True, text=True)
    return f"{name}: does not link\n{done.stderr[-2000:]}" if done.returncode != 0 else None


def run(options, name, problems, limit):
    """Runs the validation for `limit` seconds of CPU time at the most; returns its exit status, or None if it was
    stopped, what it wrote, and its CPU seconds."""
    build = options.work / (name or "unchanged")
    said = build / "said.txt"
    with said.open("w") as output:
        process = subprocess.Popen(
            [str(build / "validate"), "--quick", "--problems", ",".join(problems), "--output", str(build)],
            stdout=output, stderr=output, env={**os.environ, "OMP_NUM_THREADS": "1"},
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (limit, limit)))
        stop = threading.Timer(SECONDS, process.kill)
        stop.start()
        _, status, usage = os.wait4(process.pid, 0)
        stop.cancel()
    process.returncode = os.waitstatus_to_exitcode(status)
    was_stopped = process.returncode in (-signal.SIGXCPU, -signal.SIGKILL)
    seconds = usage.ru_utime + usage.ru_stime
    return None if was_stopped else process.returncode, said.read_text(), seconds


def verdict(options, name, problems, limit):
    """Runs a changed loop; returns (is the verdict right, message)."""
    status, said, seconds = run(options, name, problems, limit)
    if status is None:
        return True, f"{name}: did not end within {seconds:.0f} s of CPU time"
    missed = [line for line in said.splitlines() if line.startswith("MISSED")]
    first = missed[0][:150] if missed else said[-300:]
    return status == 1, f"{name}: exit status {status}, {len(missed)} bounds missed: {first}"


def main():
    parser = argparse.ArgumentParser()
    for option in ("--source", "--kernels", "--work", "--host"):
        parser.add_argument(option, type=pathlib.Path, required=True)
    parser.add_argument("--compile", required=True)
    parser.add_argument("--link", required=True)
    parser.add_argument("--only", default=",".join(DEFAULT), help="names, or all")
    parser.add_argument("--jobs", type=int, default=2)
    options = parser.parse_args()
    names = list(MUTATIONS) if options.only == "all" else options.only.split(",")
    unknown = [name for name in names if name not in MUTATIONS]
    if unknown:
        parser.error(f"there is no mutation {unknown[0]}: choose from {', '.join(MUTATIONS)}")
    stale = headers.stale(MUTATIONS, options.source / "include/myriad")
    if stale:
        parser.exit(1, "\n".join(["Mend these mutations:"] + stale) + "\n")
    wrong = 0
    examined = {name: [MUTATIONS[name][-1]] for name in names}
    examined[None] = sorted({problem for problems in examined.values() for problem in problems})
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        broken = pool.map(lambda name: build_program(options, name, examined[name]), examined)
        for message in filter(None, broken):
            parser.exit(1, f"WRONG: {message}\n")
        status, said, seconds = run(options, None, examined[None], SECONDS)
        print(f"{'WRONG' if status else 'right'}: unchanged: exit status {status} after {seconds:.1f} s of CPU time",
              said[-2000:] if status else "", flush=True)
        wrong += status != 0
        limit = math.ceil(MOST_TIMES * seconds)
        for right, text in pool.map(lambda name: verdict(options, name, examined[name], limit), names):
            print(("right: " if right else "WRONG: ") + text, flush=True)
            wrong += not right
    print(f"{len(names)} changed loops, {wrong} verdicts wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
