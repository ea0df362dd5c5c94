"""Which work unit traces which rays: depends on the number of rays only, never on the threads."""

from dataclasses import dataclass

LARGEST_UNIT = 1 << 20
# Enough units for all cores to be busy, and, by their parts, for a standard error by scatter.
FEWEST_UNITS = 16
# Sections of a direction: its work units are added up section by section, so that the sums are the same to the last
# bit wherever the sections were made.
MOST_SECTIONS = 64
# Ledgers of a direction, of which the standard errors of the audit are made; from twice as many on, neighbours
# are added up, so that a long run holds no more than a short one.
MOST_LEDGERS = 2048
# Rays of the analog run that tells the energy balance where slices come from replicates.
AUDIT_RAYS = 1 << 18
LEAST_AUDIT_RAYS = 1 << 12


@dataclass(frozen=True)
class Schedule:
    """Work units of a simulation, ordered so that all directions advance together.

    Parameters
    ----------
    directions : int
    rays : int
        Rays from each direction.
    """

    directions: int
    rays: int

    @property
    def rounds(self):
        """Work units per direction."""
        return max(FEWEST_UNITS, -(-self.rays // LARGEST_UNIT))

    def __len__(self):
        return self.rounds * self.directions

    def __getitem__(self, number):
        """Direction, unit of that direction, and rays of the ``number``-th work unit."""
        unit, direction = divmod(number, self.directions)
        first = self.rays * unit // self.rounds
        return direction, unit, self.rays * (unit + 1) // self.rounds - first

    @property
    def checkpoints(self):
        """Rounds after which to note cost and error: 1, 2, 4, ... and the last."""
        rounds = [1 << i for i in range(self.rounds.bit_length()) if 1 << i < self.rounds]
        return [*rounds, self.rounds]

    @property
    def ends(self):
        """Rounds after which a section of sums ends; the checkpoints are among them."""
        step = 1 << max(0, -(-self.rounds // MOST_SECTIONS) - 1).bit_length()
        return sorted({*self.checkpoints, *range(step, self.rounds, step)})
