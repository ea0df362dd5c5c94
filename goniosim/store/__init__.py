"""Result files: the one place that knows HDF5. `data_schema.md` describes the format."""

from h5py.version import hdf5_version

from goniosim.store.datatree import to_datatree
from goniosim.store.keeping import Standing, look_at, refuse_newer
from goniosim.store.models import ModelsFile, ModelsWriter, is_models_file, may_be_models_file, open_models
from goniosim.store.output import Reservation, reserve_output
from goniosim.store.portion import Portion, read_portion, write_portion
from goniosim.store.reader import open_result, read_header, read_scene, read_state
from goniosim.store.resuming import keeper, result_left, state_left
from goniosim.store.saving import write_result
from goniosim.store.size import predicted_size

__all__ = [
    "ModelsFile",
    "ModelsWriter",
    "Portion",
    "Reservation",
    "Standing",
    "hdf5_version",
    "is_models_file",
    "keeper",
    "look_at",
    "may_be_models_file",
    "open_models",
    "open_result",
    "predicted_size",
    "read_header",
    "read_portion",
    "read_scene",
    "read_state",
    "refuse_newer",
    "reserve_output",
    "result_left",
    "state_left",
    "to_datatree",
    "write_portion",
    "write_result",
]
