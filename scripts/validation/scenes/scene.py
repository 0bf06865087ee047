"""What the scenes share: their arguments and their result, as scripts/validation/engine.py passes them on."""

import json
import os
import sys


def arguments():
    """The arguments of this run."""
    with open(sys.argv[1], encoding="utf-8") as file:
        return json.load(file)


def leave(result):
    """Hands the result over. A run that ends without this has failed."""
    path = sys.argv[2]
    with open(path + ".new", "w", encoding="utf-8") as file:
        json.dump(result, file)
    os.replace(path + ".new", path)
