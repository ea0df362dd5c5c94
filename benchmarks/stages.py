"""What every stage of the walk costs alone, in the nearest cache: the ceiling of an event.

    python benchmarks/stages.py [--repeat 30] [--cycles 3.7]

Prints nanoseconds of processor time per ray (best of the repetitions, one thread, three channels), and the
sums that make up an event of each kind and an exit; with ``--cycles``, the clock of the processor in GHz,
also in cycles. `benchmarks/effects.py` prints what an event costs in a walk.
"""

import argparse
import time

import numpy as np

from goniosim._jit import kernel
from goniosim.engine import sorting, tally, walk
from goniosim.engine.layout import BOOST, COSINE, GAIN, N_LEDGER, N_SCRATCH, TRANSMITTED, WEIGHT, X, Y, Z
from goniosim.engine.stages import facets, lambert, masking, rough_conductor, rough_dielectric, smooth_conductor, travel
from goniosim.engine.unit import BATCH
from goniosim.slices import cells_of

CHANNELS, ROWS, COLUMNS, CLASSIC = 3, 90, 360, 0
CALLS = 200
ALPHA, ETA = 0.2, 1.5


@kernel
def _draw(calls, batch, scratch, facet, key):
    for call in range(calls):
        facets._draw(BATCH, key + np.uint64(call), facet[0], facet[1], facet[2])


@kernel
def _sample(calls, batch, scratch, facet, key):
    # Over what it drew: numbers between -1 and 1 all the same.
    for _ in range(calls):
        facets._sample(batch[X], batch[Y], batch[Z], BATCH, ALPHA, facet[0], facet[1], facet[2])
        for i in range(BATCH):
            facet[2][i] *= 0.25


@kernel
def _scale(calls, batch, scratch, facet, key):
    for _ in range(calls):
        for i in range(BATCH):
            facet[2][i] *= 0.25


@kernel
def _dielectric(calls, batch, scratch, facet, key):
    for call in range(calls):
        rough_dielectric._reflect_or_refract(
            batch[X], batch[Y], batch[Z], BATCH, ALPHA, ETA, key + np.uint64(call), facet[0], facet[1], facet[2],
            scratch[GAIN], scratch[TRANSMITTED],
        )  # fmt: skip


@kernel
def _conductor(calls, batch, scratch, facet, key):
    for _ in range(calls):
        rough_conductor._reflect(
            batch[X], batch[Y], batch[Z], BATCH, ALPHA, facet[0], facet[1], facet[2], scratch[COSINE],
            scratch[GAIN], scratch[TRANSMITTED],
        )  # fmt: skip


@kernel
def _absorb_base(calls, batch, scratch, ledger, spectral):
    for _ in range(calls):
        smooth_conductor.absorb_in_conductor(batch, BATCH, spectral, scratch[COSINE], ledger)


@kernel
def _reflect_base(calls, batch, scratch, ledger, spectral, key):
    for call in range(calls):
        lambert.scatter(batch, BATCH, spectral, key + np.uint64(call), scratch, ledger)


@kernel
def _mask(calls, batch, scratch, ledger):
    for _ in range(calls):
        masking.apply_masking(batch, BATCH, scratch, ledger)


@kernel
def _absorb(calls, batch, scratch, ledger, tau):
    for _ in range(calls):
        travel.absorb(batch, BATCH, tau, scratch[COSINE], scratch[BOOST], ledger)


@kernel
def _roulette(calls, batch, scratch, ledger, scales, key):
    for _ in range(calls):
        travel.roulette(batch, BATCH, scales, scratch[BOOST], key, ledger)


@kernel
def _sort(calls, scratch, steps, places):
    for _ in range(calls):
        sorting.sort(scratch[GAIN], scratch[TRANSMITTED], BATCH, steps, places[0], places[1])


@kernel
def _gather(calls, batch, places, counts, rows):
    for _ in range(calls):
        for way in range(2):
            walk._gather(batch, BATCH, places[way], counts[way], rows[way], 5, X)


@kernel
def _book(calls, batch, ledger):
    for _ in range(calls):
        walk._book(batch, 0, BATCH, ledger, 0)


@kernel
def _find_cells(calls, batch, light, cells):
    for _ in range(calls):
        cells_of(CLASSIC, batch[X], batch[Y], batch[Z], BATCH, ROWS, COLUMNS, light, cells)


@kernel
def _deposit(calls, batch, histogram, cells):
    for call in range(calls):
        tally.add_deposits(histogram, cells[call % cells.shape[0]], batch, BATCH, CHANNELS)


@kernel
def _sort_once(scratch, steps, places):
    return sorting.sort(scratch[GAIN], scratch[TRANSMITTED], BATCH, steps, places[0], places[1])


def measure(repeat):
    """Nanoseconds per ray of every stage, by name."""
    rng = np.random.default_rng(1)
    view = rng.normal(size=(3, BATCH))
    view[Z] = np.abs(view[Z]) + 0.3
    view /= np.linalg.norm(view, axis=0)
    fresh = np.vstack([view, np.ones((CHANNELS, BATCH))])
    room = BATCH + sorting.LANES
    batch, scratch = tally.aligned((WEIGHT + CHANNELS, room)), tally.aligned((N_SCRATCH, room))
    facet, rows = tally.aligned((3, room)), tally.aligned((2, WEIGHT + CHANNELS, 2 * room))
    steps, places = np.empty(BATCH, np.uint64), np.empty((2, BATCH), np.uint32)
    ledger = np.zeros((N_LEDGER, CHANNELS))
    histogram = tally.empty_records(2 * ROWS * COLUMNS, CHANNELS)
    found = np.zeros(BATCH, np.int32)
    cells = rng.integers(0, len(histogram), (64, BATCH)).astype(np.int32)
    key = np.uint64(12345)
    one, mirror = np.ones((2, CHANNELS)), np.array([[0.2] * CHANNELS, [1e3] * CHANNELS])
    # So thin that the weights last for all calls.
    tau = np.array([1e-5, 2e-5, 3e-5])

    def normals():
        _draw(1, batch, scratch, facet, key)
        _sample(1, batch, scratch, facet, key)

    def outcome():
        scratch[GAIN] = rng.random(room) > 0.02
        scratch[TRANSMITTED] = rng.random(room) > 0.4

    def nothing():
        scratch[GAIN], scratch[TRANSMITTED], scratch[COSINE, :BATCH] = 1.0, 0.0, view[Z]

    outcome()
    counts = np.array(_sort_once(scratch, steps, places))
    several = (batch, scratch, facet, key)
    stages = {
        "draw azimuth and height": (_draw, several, nothing),
        "sample a facet": (_sample, several, normals),
        "reflect or refract": (_dielectric, several, normals),
        "reflect": (_conductor, several, normals),
        "conductor, Fresnel": (_absorb_base, (batch, scratch, ledger, mirror), nothing),
        "Lambertian base": (_reflect_base, (batch, scratch, ledger, one, key), nothing),
        "masking": (_mask, (batch, scratch, ledger), nothing),
        "absorption": (_absorb, (batch, scratch, ledger, tau), nothing),
        "roulette, none faint": (_roulette, (batch, scratch, ledger, np.full(CHANNELS, 2.0), key), nothing),
        "sort": (_sort, (scratch, steps, places), outcome),
        "gather": (_gather, (batch, places, counts, rows), lambda: None),
        "book": (_book, (batch, ledger), nothing),
        "cells, classic": (_find_cells, (batch, fresh[:, 0].copy(), found), nothing),
        "deposit, two slices": (_deposit, (batch, histogram, cells), nothing),
        "(scale)": (_scale, several, normals),
    }
    best = dict.fromkeys(stages, float("inf"))
    for turn in range(repeat + 1):
        for name, (run, arguments, begin) in stages.items():
            batch[:, :BATCH] = fresh
            begin()
            calls = CALLS if turn else 1
            start = time.thread_time_ns()
            run(calls, *arguments)
            if turn:  # the first turn compiles
                best[name] = min(best[name], (time.thread_time_ns() - start) / (calls * BATCH))
    best["sample a facet"] -= best.pop("(scale)")
    return best


ROUGH = ("draw azimuth and height", "sample a facet", "masking")
BETWEEN = ("absorption", "roulette, none faint", "sort", "gather")
SUMS = {
    "dielectric event": (*ROUGH, "reflect or refract", *BETWEEN),
    "conductor event": (*ROUGH, "reflect", "conductor, Fresnel", *BETWEEN),
    "Lambertian event": ("Lambertian base", *BETWEEN),
    "exit": ("book", "cells, classic", "deposit, two slices"),
}


def main():
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--repeat", type=int, default=30)
    parser.add_argument("--cycles", type=float, metavar="GHZ", help="clock of the processor, to print cycles, too")
    options = parser.parse_args()
    best = measure(options.repeat)
    sums = {name: sum(best[part] for part in parts) for name, parts in SUMS.items()}
    head = f"{'cycles':>9}" if options.cycles else ""
    print(f"{'stage':26}{'ns/ray':>9}{head}")
    for table in (best, sums):
        for name, ns in table.items():
            cycles = f"{ns * options.cycles:9.1f}" if options.cycles else ""
            print(f"{name:26}{ns:9.2f}{cycles}")
        print()


if __name__ == "__main__":
    main()
