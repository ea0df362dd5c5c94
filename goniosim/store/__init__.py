"""Result files: the one place that knows HDF5. `data_schema.md` describes the format."""

from h5py.version import hdf5_version

from goniosim.store.models import ModelsFile, ModelsWriter, is_models_file, may_be_models_file, open_models
from goniosim.store.output import Reservation, reserve_output
from goniosim.store.reader import open_result, read_header
from goniosim.store.size import predicted_size
from goniosim.store.writer import write_result

__all__ = [
    "ModelsFile",
    "ModelsWriter",
    "Reservation",
    "hdf5_version",
    "is_models_file",
    "may_be_models_file",
    "open_models",
    "open_result",
    "predicted_size",
    "read_header",
    "reserve_output",
    "write_result",
]
