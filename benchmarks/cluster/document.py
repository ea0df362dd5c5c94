"""The measured part of docs/cluster.md: between two markers, never by hand."""

import re

from goniosim.provenance import provenance
from goniosim.report import text

BEGIN = "<!-- written by `make cluster-overhead` -->"
END = "<!-- end of what `make cluster-overhead` writes -->"
# A shard fills ten minutes; materials of a study as large as the paper's.
WORK, MATERIALS = 600.0, 60
SHARDS = (16, 100, 1000, 10_000)

PAGE = """\
Measured by `make cluster-overhead` ({machine}, {cores} cores; three materials at seven directions, 90 x 360 cells,
{plain} in one go):

| what | cost |
|---|---:|
| start-up of a shard, kernels in the cache | {warm} |
| start-up of a shard, empty cache (compiles) | {cold} |
| a checkpoint of {checkpoint_size} | {checkpoint} |
| all else of a shard: the sums set up, its file written | {further} |
| merge, for each material (direct reflection, audit, the result's file) | {merge_fixed} |
| merge, for each GB of portions | {merge_rate} |

{cuts}

What follows for shards of {work} of work each, {materials} materials, portions of {portion} each:

{model}

*Efficiency* is work over all the time that passes: start-up, work, and the merge, which waits for the last shard.
{limit}
"""


def write(measured, path):
    """Put what was measured between the markers of a file."""
    before = path.read_text(encoding="utf-8")
    pattern = re.compile(f"({re.escape(BEGIN)}\n).*?({re.escape(END)})", re.DOTALL)
    if len(pattern.findall(before)) != 1:
        raise ValueError(f"{path}: must hold {BEGIN} and {END} once each; put them back")
    page = page_of(measured)
    path.write_text(pattern.sub(lambda match: f"{match[1]}{page}\n{match[2]}", before), encoding="utf-8")


def page_of(measured):
    """The text between the markers."""
    last = measured.cuts[-1]
    portion = last.size / last.files
    known = provenance(1)
    return PAGE.format(
        machine=known["processor"],
        cores=known["cores"],
        plain=text.duration(measured.plain),
        warm=text.duration(measured.warm),
        cold=text.duration(measured.cold),
        checkpoint_size=text.size(measured.checkpoint_size),
        checkpoint=text.duration(measured.checkpoint),
        further=text.duration(max(0.0, further(measured))),
        merge_fixed=text.duration(measured.merge_fixed),
        merge_rate=text.duration(measured.merge_rate),
        cuts=_table(
            ["shards", "all shards one by one", "merge", "files", "size"],
            [
                [c.shards, text.duration(c.traced), text.duration(c.merged), c.files, text.size(c.size)]
                for c in measured.cuts
            ],
        ),
        work=text.duration(WORK),
        materials=MATERIALS,
        portion=text.size(portion),
        model=_table(
            ["shards", "merge", "disk", "wall-clock", "efficiency"],
            [_row(measured, shards, portion) for shards in SHARDS],
        ),
        limit=_limit(measured, portion),
    ).rstrip()


def further(measured):
    """Seconds of a shard beside its work and its start-up."""
    first, last = measured.cuts[0], measured.cuts[-1]
    return (last.traced - first.traced) / (last.shards - first.shards) - measured.warm


def start(measured):
    """Seconds of a shard beside its work."""
    return measured.warm + max(0.0, further(measured))


def merge_seconds(measured, shards, portion):
    """Of so many shards."""
    files = shards + MATERIALS - 1
    return MATERIALS * measured.merge_fixed + measured.merge_rate * files * portion / 1e9


def _row(measured, shards, portion):
    merge = merge_seconds(measured, shards, portion)
    whole = WORK + start(measured) + merge
    size = text.size((shards + MATERIALS - 1) * portion)
    return [shards, text.duration(merge), size, text.duration(whole), _percent(WORK / whole)]


def _limit(measured, portion):
    most = SHARDS[-1]
    merge, begin = merge_seconds(measured, most, portion), start(measured)
    name = "the merge, which reads all portions one after the other" if merge > begin else "the start-up of the shards"
    share = max(merge, begin) / (most * WORK)
    return (
        f"What limits first is {name}: {text.duration(max(merge, begin))} at {most} shards.\n"
        f"These have done {text.duration(most * WORK)} of work by then: it is {_percent(share)} of the time of all."
    )


def _percent(share):
    return f"{100.0 * share:.2g} %" if share < 0.995 else f"{100.0 * share:.1f} %"


def _table(header, rows):
    lines = ["| " + " | ".join(map(str, cells)) + " |" for cells in (header, *rows)]
    return "\n".join([lines[0], "|" + "---:|" * len(header), *lines[1:]])
