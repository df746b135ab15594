"""Pictures to the objects they are made of - shape, position, size, angle, color, confidence - and back.

>>> import dvp, numpy
>>> picture = numpy.full((64, 64, 3), 255, numpy.uint8)
>>> picture[16:48, 16:48] = (30, 60, 200)
>>> scene = dvp.fit(picture)
>>> scene.objects[0].kind, scene.objects[0].color
('rectangle', (0.11764706, 0.23529412, 0.78431374))
>>> bool((scene.render() == picture).all())
True

=====================  =====================================================================
:func:`fit`            a picture (array, path, bytes, PIL image) to a :class:`Scene`
:func:`fit_many`       many, on all cores; errors come as values
:class:`Fitter`        the same with options and memory kept
:class:`Scene`         objects, image, SVG, JSON, label map, measures, descriptors
:func:`measures`       measures of many scenes by columns; :func:`table` as a table of pyarrow
:func:`efd`            elliptic Fourier descriptors of contours; :func:`efd_center`
:func:`generate`       random scenes
:func:`evaluate`       scores of scenes
``dvp.torch``          the renderer and its loss, differentiable in PyTorch
``dvp.jax``            the same in JAX
``dvp.ray``            many pictures on a cluster; :func:`map_in_arrow` and :func:`spark_schema` for Spark
``python -m dvp``      the command
=====================  =====================================================================

Coordinates of objects are in units of the *shorter* side of the picture, x to the right, y down; measures are in pixels.
"""

from ._batches import map_in_arrow, spark_schema
from ._dvp import VERSION as __version__
from ._dvp import DvpError
from ._efd import efd, efd_center
from ._fit import MAX_PIXELS, Fitter, fit, fit_many
from ._samples import Scores, evaluate, generate
from ._scene import Object, Scene, measures, table

__all__ = [
    "MAX_PIXELS",
    "DvpError",
    "Fitter",
    "Object",
    "Scene",
    "Scores",
    "__version__",
    "efd",
    "efd_center",
    "evaluate",
    "fit",
    "fit_many",
    "generate",
    "map_in_arrow",
    "measures",
    "spark_schema",
    "table",
]
