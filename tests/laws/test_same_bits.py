"""However the work is shared out, the bits are the same: among threads, and among shards."""

from hypothesis import strategies as st

from goniosim.engine import join_portions, piece_rays, simulate, trace_portion
from goniosim.scene import parse_scene
from laws.law import law
from laws.strategies import scenes
from sameness import content


@law(fast=6, slow=150, scene=scenes(), threads=st.sampled_from([2, 3]))
def test_several_threads_make_what_one_makes(scene, threads):
    parsed = parse_scene(scene)
    assert content(simulate(parsed, threads=threads)) == content(simulate(parsed, threads=1))


@law(fast=6, slow=150, scene=scenes(), shares=st.lists(st.floats(0.0, 1.0), max_size=4))
def test_shards_join_to_the_whole(scene, shares):
    """What a shard traces are pieces in a row; some may be empty."""
    parsed = parse_scene(scene)
    count = len(piece_rays(parsed))
    edges = sorted({0, count, *(round(share * count) for share in shares)})
    states = [trace_portion(parsed, first, end).state for first, end in zip(edges, edges[1:], strict=False)]
    assert content(join_portions(parsed, states)) == content(simulate(parsed))
