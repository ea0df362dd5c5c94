"""Throughput of the analog estimator: rays per CPU-second on three stacks at three angles.

    python benchmarks/throughput.py [--rays 8e6] [--peer PATH] [--repeat 9]

Prints one table: goniosim, the slow one-ray-at-a-time reference tracer of the tests, and, with
``--peer``, a C++ goniometer that traces one ray at a time (an executable that takes
``--theta --n --threads --stack --out --moments`` and prints JSON with ``cpu_seconds``). Everything is
measured in one run, in turns, on one thread, error bars included; the median of the repetitions counts, for the
ratio to the C++ program the median of that of neighbouring runs.
"""

import argparse
import json
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from goniosim.engine import simulate
from goniosim.scene import parse_scene

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests"))
from reference.tracer import stack_from_scene, trace  # noqa: E402

ANGLES = (30.0, 60.0, 80.0)

LAYERS = {
    "plastic": [
        {"interface": {"type": "dielectric", "eta": 1.5, "alpha": 0.05}},
        {"medium": {"tau": [0.05, 0.1, 0.4]}},
        {"interface": {"type": "lambert", "rho": [0.1, 0.6, 0.2]}},
    ],
    "metal": [
        {"interface": {"type": "dielectric", "eta": 1.5, "alpha": 0.2}},
        {"medium": {"tau": 0.1}},
        {"interface": {"type": "conductor", "eta": 1.45, "kappa": [1.0, 0.01, 0.01], "alpha": 0.2}},
    ],
    "slab": [
        {"interface": {"type": "dielectric", "eta": 1.5, "alpha": 0.001}},
        {"medium": {"tau": [0.05, 0.1, 0.4]}},
        {"interface": {"type": "dielectric", "eta": 1.0, "alpha": 0.2}},
    ],
}


def scene(name, theta):
    """The named stack, lit from ``theta`` degrees."""
    material = {"name": name, "layers": LAYERS[name]}
    return parse_scene({"material": material, "incident": {"theta_deg": [theta]}})


def stack_text(layers):
    """The stack in the text format of the C++ program."""
    lines = []
    for layer in layers:
        if "medium" in layer:
            lines.append(f"medium {_three(layer['medium']['tau'])}")
            continue
        i = layer["interface"]
        if i["type"] == "dielectric":
            lines.append(f"interface {i['alpha']} {i['eta']}")
        elif i["type"] == "lambert":
            lines.append(f"lambert {_three(i['rho'])}")
        else:
            lines.append(f"conductor {i['alpha']} {_three(i['eta'])} {_three(i['kappa'])}")
    return "\n".join(lines) + "\n"


def _three(value):
    return " ".join(str(x) for x in (value if isinstance(value, list) else [value] * 3))


def goniosim_rate(name, theta, rays):
    """Rays per CPU-second of the engine, error bars and energy audit included."""
    cost = simulate(scene(name, theta), rays=rays, threads=1, estimator="analog").cost
    return rays / cost.cpu_seconds[0, -1]


def reference_rate(name, theta, rays):
    """Rays per CPU-second of the reference tracer."""
    stack = stack_from_scene(scene(name, theta))
    start = time.process_time()
    trace(stack, theta, rays, seed=1)
    return rays / (time.process_time() - start)


def peer_rate(program, name, theta, rays):
    """Rays per CPU-second of the C++ program."""
    with tempfile.TemporaryDirectory() as folder:
        stack = Path(folder) / "stack.txt"
        stack.write_text(stack_text(LAYERS[name]))
        out = Path(folder) / "out"
        command = [program, "--theta", theta, "--n", rays, "--threads", 1, "--stack", stack, "--out", out]
        subprocess.run([*(str(part) for part in command), "--moments", "--quiet"], check=True)
        with open(out, "rb") as f:
            return rays / json.loads(f.readline())["runs"][0]["cpu_seconds"]


def main():
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rays", type=float, default=8e6, help="rays per measurement of goniosim")
    parser.add_argument("--repeat", type=int, default=9)
    parser.add_argument("--peer", help="executable of a C++ goniometer to compare with")
    options = parser.parse_args()
    rays = int(options.rays)

    runners = {
        "goniosim": lambda n, t: goniosim_rate(n, t, rays),
        "reference": lambda n, t: reference_rate(n, t, rays // 50),
    }
    if options.peer:
        runners["C++"] = lambda n, t: peer_rate(options.peer, n, t, rays // 5)
    for run in runners.values():
        run("slab", 0.0)  # compile, or load from the cache, before the clock starts
    print("million rays per CPU-second, one thread, analog estimator, RGB")
    ratio_head = f"{'x C++':>9}" if options.peer else ""
    print(f"{'stack':10}{'theta':>6}" + "".join(f"{name:>12}" for name in runners) + ratio_head)
    for name in LAYERS:
        for theta in ANGLES:
            rates = {key: [] for key in runners}
            for _ in range(options.repeat):
                for key, run in runners.items():
                    rates[key].append(run(name, theta))
            ratio = ""
            if options.peer:
                ratio = f"{statistics.median(a / b for a, b in zip(rates['goniosim'], rates['C++'], strict=True)):9.1f}"
            row = "".join(f"{statistics.median(rates[key]) / 1e6:12.2f}" for key in runners)
            print(f"{name:10}{theta:6.0f}{row}{ratio}", flush=True)


if __name__ == "__main__":
    main()
