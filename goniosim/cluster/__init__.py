"""Simulations in shards, on any number of machines: cut, traced, looked after and merged."""

from goniosim.cluster.division import Division, Task
from goniosim.cluster.merging import merge
from goniosim.cluster.plan_file import ShardPlan, plan_of
from goniosim.cluster.shard import array_list, parse_shard
from goniosim.cluster.spreading import remove_shards, shards_folder, spread
from goniosim.cluster.standing import Standing, State, standing_of
from goniosim.cluster.tracing import error_path, run_shard
from goniosim.cluster.uniting import merge_results

__all__ = [
    "Division",
    "ShardPlan",
    "Standing",
    "State",
    "Task",
    "array_list",
    "error_path",
    "merge",
    "merge_results",
    "parse_shard",
    "plan_of",
    "remove_shards",
    "run_shard",
    "shards_folder",
    "spread",
    "standing_of",
]
