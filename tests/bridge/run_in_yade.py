#!/usr/bin/python3
"""Runs a test script in stock YADE: fails unless YADE ends well and says that all claims hold."""

import argparse
import os
import re
import subprocess
import sys


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--yade", default="yade", help="the program that runs YADE")
    parser.add_argument("--module-path", required=True, help="folder with the package yadelbm")
    parser.add_argument("--timeout", type=float, default=120, help="seconds")
    parser.add_argument("script")
    arguments = parser.parse_args()

    environment = dict(os.environ)
    here = os.path.dirname(os.path.abspath(__file__))
    environment["PYTHONPATH"] = os.pathsep.join([arguments.module_path, here])
    command = [arguments.yade, "-n", "-x", "-j1", os.path.abspath(arguments.script)]
    try:
        run = subprocess.run(
            command,
            env=environment,
            timeout=arguments.timeout,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            errors="replace",
        )
    except subprocess.TimeoutExpired as expired:
        print((expired.stdout or b"").decode(errors="replace"))
        print("%s did not end within %g s" % (arguments.script, arguments.timeout))
        return 1
    print(run.stdout)
    # a crash at exit or a script that ended early must not pass for success
    said = re.search(r"^claims: [1-9]\d* hold, 0 fail$", run.stdout, re.MULTILINE)
    if run.returncode != 0 or not said:
        print("exit status %d" % run.returncode)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
