"""All models by name, in the order in which they are listed everywhere."""

from .belcour import bati19_belcour, belcour18_forward, belcour18_symmetric
from .weidlich_wilkie import bati19_ww, elek10, ww09

MODELS = {
    module.MODEL.name: module.MODEL
    for module in (ww09, elek10, bati19_ww, belcour18_forward, belcour18_symmetric, bati19_belcour)
}
