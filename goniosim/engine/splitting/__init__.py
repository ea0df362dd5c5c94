"""The split walk: light enters without a coin, leaves without a coin, and is deposited wherever it may leave.

As `goniosim.engine.walk` it is sorted by event. What differs: no ray is spent on the direct reflection, every arrival
at a way out makes several deposits there and goes on, weighted, inside; between inner interfaces both branches are
followed. Rays wait in queues by interface, side, and phase (`layout`), so that those of a batch draw their random
numbers alike, and have all forgotten their azimuth or none of them.
"""
