"""Claims of processes that are elsewhere, or no more."""

import json
import os
import time

from goniosim.claims import Claim

# More than any process has for a number.
GONE = 4_194_305
ELSEWHERE = {"host": "n042", "boot": "0" * 8}


def leave(target, age=0.0, **record):
    """A claim without a lock, as a process leaves it that was killed ``age`` seconds after its last sign of life.

    Parameters
    ----------
    target : Path
    age : float
    **record
        What it says of its owner, otherwise of this process.

    Returns
    -------
    Path
    """
    with Claim(target):
        (path,) = target.parent.glob(f".{target.name}.*.claim")
        text = path.read_text()
    path.write_text(json.dumps({**json.loads(text), **record}) if record else text)
    os.utime(path, (time.time() - age,) * 2)
    return path
