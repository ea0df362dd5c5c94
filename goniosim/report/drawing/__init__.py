"""What the figures of simulations and of comparisons share: panels, tone, views of a slice, legends.

Importing it sets matplotlib up, so it comes before everything else of matplotlib's.
"""

from .setup import import_matplotlib

import_matplotlib()
