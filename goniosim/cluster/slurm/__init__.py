"""Slurm: the scripts of a job array and of the merge that follows it, and the plain `sbatch` that submits them."""

from goniosim.cluster.slurm.queue import commands, submit
from goniosim.cluster.slurm.script import LOGS, Jobs, result_of, results_of, scripts

__all__ = ["LOGS", "Jobs", "commands", "result_of", "results_of", "scripts", "submit"]
