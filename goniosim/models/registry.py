"""All models by name, in the order in which they are listed everywhere."""

from . import (
    bati19_belcour,
    bati19_ww,
    belcour18_forward,
    belcour18_symmetric,
    elek10,
    ww09,
)

MODELS = {
    module.MODEL.name: module.MODEL
    for module in (ww09, elek10, bati19_ww, belcour18_forward, belcour18_symmetric, bati19_belcour)
}
