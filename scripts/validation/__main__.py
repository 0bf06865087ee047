"""Command line of scripts/validate."""

import argparse
import os
import sys
import time
from concurrent.futures import ThreadPoolExecutor, as_completed

from . import catalogue, report
from .case import Result
from .engine import ROOT, RunFailed
from .store import Store, this_session

SPEED = 0.08  # cell updates [1e9/s] of one thread, for the estimates


def perform(run, session):
    """Does a run; a failure is a result too."""
    start = time.monotonic()
    result = Result(run.function.__name__, run.arguments, session=session)
    try:
        result.values = run.function(**run.arguments)
    except RunFailed as failure:
        result.failure = str(failure)
    result.seconds = round(time.monotonic() - start, 2)
    return result


def do_runs(cases, folder, options):
    """Does what is missing (or everything), side by side, the longest runs first; shows progress."""
    stores = {case.name: Store(folder, case.name) for case in cases}
    session = this_session(options.jobs)
    waiting = []
    for case in cases:
        store = stores[case.name]
        number = store.open_session(session)
        waiting += [(case, run, number) for run in case.runs(options.quick)
                    if not (options.keep and (found := store.find(run)) and not found.failure)]
    waiting.sort(key=lambda item: -item[1].cost)
    total, done, start = sum(run.cost for _, run, _ in waiting), 0.0, time.monotonic()
    print(f"{len(waiting)} runs, about {total / SPEED / options.jobs / 60:.1f} min with {options.jobs} at a time", flush=True)
    with ThreadPoolExecutor(options.jobs) as pool:
        futures = {pool.submit(perform, run, number): (case, run) for case, run, number in waiting}
        try:
            for count, future in enumerate(as_completed(futures), 1):
                case, run = futures[future]
                result = future.result()
                stores[case.name].put(result)
                done += run.cost
                elapsed = time.monotonic() - start
                left = elapsed * (total - done) / done if done else 0
                what = ", ".join(f"{key} {value}" for key, value in run.arguments.items())
                print(f"[{count}/{len(waiting)}, {elapsed:.0f} s, {left:.0f} s left] {case.name}: {what}"
                      f"  {result.seconds:.1f} s{'  FAILED: ' + result.failure if result.failure else ''}", flush=True)
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise
    for case in cases:
        stores[case.name].keep_only(case.runs(options.quick))


def show_list(cases):
    """A line per case, with the cost of its tiers."""
    width = max(len(case.name) for case in cases)
    for case in cases:
        minutes = [sum(run.cost for run in case.runs(quick)) / SPEED / 60 for quick in (False, True)]
        print(f"{case.name:<{width}}  {case.title}  ({minutes[0]:.1f} min of one core, quick {minutes[1]:.1f})")


def shortfalls(cases, folder):
    """What misses its target, and runs without a result."""
    found = []
    for case in cases:
        good = [result for result in Store(folder, case.name).results if not result.failure]
        found += [f"{case.name}: {row.quantity}: {report.percent(row.error)}, target {report.bound(row)}"
                  for row in (case.rows(good) if good else []) if row.met is False]
        found += [f"{case.name}: {result.arguments}: {result.failure}" for result in Store(folder, case.name).results if result.failure]
    return found


def main():
    parser = argparse.ArgumentParser(prog="scripts/validate", description="Validation studies; scripts/validate --help says more.")
    parser.add_argument("case", nargs="*")
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--keep", action="store_true")
    parser.add_argument("--report", action="store_true")
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--output")
    options = parser.parse_args()
    known = {case.name: case for case in catalogue.CASES}
    unknown = [name for name in options.case if name not in known]
    if unknown:
        sys.exit(f"validate: no case {', '.join(unknown)}; the cases are {', '.join(known)}")
    if options.jobs < 1:
        sys.exit(f"validate: --jobs {options.jobs}: must be at least 1")
    cases = [case for case in catalogue.CASES if not options.case or case.name in options.case]
    folder = os.path.abspath(options.output or os.path.join(ROOT, *(["results"] if options.quick else ["docs"]), "validation"))
    if options.list:
        show_list(cases)
        return
    if not options.report:
        do_runs(cases, folder, options)
    print(report.make(catalogue.CASES, folder, folder + ".md"))
    if options.check and (found := shortfalls(cases, folder)):
        sys.exit("\n".join(found))


if __name__ == "__main__":
    main()
