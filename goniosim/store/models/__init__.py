"""Files of integrated models, ``models.h5``: what `goniosim compare` leaves behind of the slices it integrated."""

from goniosim.store.models.reader import ModelsFile, is_models_file, may_be_models_file, open_models
from goniosim.store.models.writer import ModelsWriter

__all__ = ["ModelsFile", "ModelsWriter", "is_models_file", "may_be_models_file", "open_models"]
