"""Stored results: one JSON file per case, one line per run."""

import datetime
import json
import os
import subprocess

from .case import Result
from .engine import ROOT


def this_session(jobs):
    """Where and when results are made; the commit is the last one that changed engine or bridge."""
    def git(*words):
        return subprocess.run(["git", "-C", ROOT, *words], capture_output=True, text=True).stdout.strip()

    commit = git("log", "-1", "--format=%h", "--abbrev=10", "--", "lbm_engine", "yade_bridge") or "unknown"
    if git("status", "--porcelain", "--untracked-files=no", "--", "lbm_engine", "yade_bridge"):
        commit += " with changes"
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        names = [line.split(":", 1)[1].strip() for line in file if line.startswith("model name")]
    return {
        "commit": commit,
        "date": datetime.datetime.now().isoformat(timespec="minutes"),
        "cpu": names[0] if names else "unknown",
        "cores": os.cpu_count(),
        "jobs": jobs,
    }


class Store:
    """The results of one case."""

    def __init__(self, folder, name):
        self.path = os.path.join(folder, name + ".json")
        self.sessions, self.results = [], []
        if os.path.exists(self.path):
            with open(self.path, encoding="utf-8") as file:
                stored = json.load(file)
            self.sessions = stored["sessions"]
            self.results = [Result(**run) for run in stored["runs"]]

    def find(self, run):
        """The stored result of a run, or None."""
        for result in self.results:
            if result.function == run.function.__name__ and result.arguments == run.arguments:
                return result
        return None

    def open_session(self, session):
        """Number of a session, for the results that it makes."""
        self.sessions.append(session)
        return len(self.sessions) - 1

    def put(self, result):
        """Takes the place of an older result of the same run; writes the file."""
        self.results = [old for old in self.results
                        if (old.function, old.arguments) != (result.function, result.arguments)] + [result]
        self.write()

    def keep_only(self, runs):
        """Drops results of runs that are not in the case any more."""
        order = [self.find(run) for run in runs]
        self.results = [result for result in order if result is not None]
        used = sorted({result.session for result in self.results})
        self.sessions = [self.sessions[i] for i in used]
        for result in self.results:
            result.session = used.index(result.session)
        self.write()

    def write(self):
        os.makedirs(os.path.dirname(self.path), exist_ok=True)
        sessions = ",\n".join("  " + json.dumps(session) for session in self.sessions)
        runs = ",\n".join("  " + json.dumps(vars(result), sort_keys=True) for result in self.results)
        with open(self.path + ".new", "w", encoding="utf-8") as file:
            file.write(f'{{"sessions": [\n{sessions}\n],\n"runs": [\n{runs}\n]}}\n')
        os.replace(self.path + ".new", self.path)
