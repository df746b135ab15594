"""Scenes: what was found in a picture."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _dvp
from ._dvp import DvpError
from ._inputs import Bank, Picture, bank_text, source

if TYPE_CHECKING:
    import pyarrow as pa


# What every object has beside the numbers of its shape; what changes nothing is left out of files.
_PLACED = ("translation", "scale", "rotation", "color", "ramp", "confidence", "known")


@dataclass(frozen=True)
class Object:
    """An object of a scene: its outline in a frame of its own goes to ``scale * R(rotation) @ v + translation``.

    *Units*: the shorter side of the picture is 1, x to the right, y down; radians from +x to +y.
    """

    #: What tables and label maps call it: its place in the order of painting, from 1, or its label.
    number: int
    #: ``circle``, ``ellipse``, ``rectangle``, ``regular_polygon``, ``star``, ``polygon``, ``path``, ``stroke``, ``efd`` or ``prototype``.
    kind: str
    #: The numbers of its shape, as in scene files.
    shape: dict[str, Any] = field(repr=False)
    translation: tuple[float, float]
    scale: float
    rotation: float
    #: Red, green, blue; 0 to 1. Of a ramp the mean of its stops.
    color: tuple[float, float, float]
    #: Probability of being there, and opacity; 0 to 1.
    confidence: float
    #: What the fit knows of its numbers (deviations, marginal gain, doubts), as in scene files; empty if nothing.
    known: dict[str, Any] = field(repr=False)
    #: The colors between which it changes from place to place, as in scene files; None if it has one color.
    ramp: dict[str, Any] | None = field(default=None, repr=False)


class Scene:
    """A background and objects, as :func:`dvp.fit` and :func:`dvp.generate` make them. It never changes.

    >>> import dvp
    >>> scene = dvp.generate(seed=7)[0]
    >>> scene.size
    (128, 128)
    >>> dvp.Scene.from_json(scene.to_json()) == scene
    True
    """

    __slots__ = ("_native", "_parsed")

    def __init__(self, native: _dvp.Scene) -> None:
        """For the functions of this package; take :meth:`from_json` for texts."""
        self._native = native
        self._parsed: dict[str, Any] | None = None

    @staticmethod
    def from_json(text: str, *, bank: Bank | None = None) -> Scene:
        """The scene of a JSON text of any version, every number checked; ``bank`` for prototypes that are only named.

        What a text does not hold is lost: numbers of objects that came from labels, and how deviations go together.

        >>> import dvp
        >>> dvp.Scene.from_json('{"version": 9}')
        Traceback (most recent call last):
            ...
        dvp.DvpError: scene: format version 9, this program reads versions 1 to 3; use a newer dvp
        """
        return Scene(_dvp.Scene.from_json(text, bank_text(bank)))

    @property
    def width(self) -> int:
        """Columns of the picture."""
        return self._native.width

    @property
    def height(self) -> int:
        """Rows of the picture."""
        return self._native.height

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the picture, as PIL has them."""
        return self._native.width, self._native.height

    @property
    def objects(self) -> list[Object]:
        """The objects, in the order of painting."""
        return [_object(of, number) for of, number in zip(self._json["objects"], self._native.numbers)]

    @property
    def background(self) -> tuple[float, float, float] | None:
        """Red, green, blue, 0 to 1; None where there is nothing behind the objects."""
        color = self._json["background"]
        if color is None:
            return None
        red, green, blue = color
        return red, green, blue

    @property
    def transparent(self) -> bool:
        """Whether there is nothing behind the objects."""
        return self._json["background"] is None

    @property
    def known(self) -> dict[str, Any]:
        """What the fit knows of the scene as a whole, as in scene files: why it stopped, doubts, noise; empty if nothing."""
        return dict(self._json.get("known") or {})

    @property
    def mae(self) -> float | None:
        """Mean absolute error of the reconstruction against the picture; None for scenes that were not found in one."""
        return self._native.mae

    @property
    def seconds(self) -> float | None:
        """Processor time of the fit."""
        return self._native.seconds

    @property
    def _json(self) -> dict[str, Any]:
        if self._parsed is None:
            self._parsed = json.loads(self._native.to_json())
        return self._parsed

    def to_json(self) -> str:
        """One line of JSON, as ``dvp fit`` writes it to STEM.json."""
        return self._native.to_json()

    def to_svg(self) -> str:
        """The SVG, as ``dvp fit`` writes it: an element per object, its id ``object-NUMBER``."""
        return self._native.to_svg()

    def _repr_svg_(self) -> str:
        return self._native.to_svg()

    def render(
        self, size: tuple[int, int] | None = None, *, rgba: bool | None = None, dtype: npt.DTypeLike = np.uint8
    ) -> npt.NDArray[Any]:
        """Paints the scene: height x width x 3, or x 4 with straight colors and alpha, as files hold them.

        ``size`` is width and height, by default those of the picture; ``rgba`` by default whether the scene is transparent;
        ``dtype`` uint8 or a float type (0 to 1).

        >>> import dvp
        >>> dvp.generate()[0].render((64, 32)).shape
        (32, 64, 3)
        """
        wanted = np.dtype(dtype)
        if wanted != np.uint8 and wanted.kind != "f":
            raise DvpError(f"dtype {wanted}: must be uint8 or a float type")
        try:
            width, height = self.size if size is None else (int(side) for side in size)
        except TypeError as error:
            raise DvpError(f"size {size!r}: must be (width, height)") from error
        if width < 0 or height < 0:
            raise DvpError(f"size {size!r}: sides must be at least 1")
        image = self._native.render((width, height), self.transparent if rgba is None else rgba)
        if wanted == np.uint8:
            return (image.astype(np.float64).clip(0, 1) * 255 + 0.5).astype(np.uint8)
        return image.astype(wanted, copy=False)

    def labels(self, picture: Picture = None) -> npt.NDArray[np.uint32]:
        """Which object is seen in each pixel: 0 the background, else the number of the object; height x width.

        With the ``picture`` that the scene was read from, pixels of its edges that refute the scene go to what they show.
        """
        return self._native.labels(None if picture is None else source(picture)[0])

    def whole(self) -> npt.NDArray[np.float32]:
        """The coverage of every object, hidden parts included, 0 to 1: objects x height x width."""
        return self._native.whole()

    def outlines(self) -> list[list[npt.NDArray[np.float64]]]:
        """Per object its rings in pixels (corners x 2, (0, 0) the outer corner of the first pixel): each outer one is
        followed by its holes, which turn the other way."""
        return self._native.rings()

    def efd(self, harmonics: int = 20, *, normalize: bool = True) -> npt.NDArray[np.float64]:
        """Elliptic Fourier descriptors of the outline around the largest part of each object, in pixels: objects x harmonics x 4,
        NaN for what encloses nothing. Conventions: those of :func:`dvp.efd`.
        """
        if not 1 <= harmonics <= 1024:
            raise DvpError(f"{harmonics} harmonics: must be 1 to 1024")
        return self._native.efd(harmonics, normalize)

    def measures(self, *, name: str = "", pixel_mm: float | None = None) -> dict[str, list[Any]]:
        """What ``dvp fit --table`` tells, by columns: a row per object. See :func:`dvp.measures`."""
        return measures([self], names=[name], pixel_mm=pixel_mm)

    def table(self, *, name: str = "", pixel_mm: float | None = None) -> pa.Table:
        """The same as a table of pyarrow, which must be there. See :func:`dvp.table`."""
        return table([self], names=[name], pixel_mm=pixel_mm)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Scene):
            return NotImplemented
        return self.to_json() == other.to_json() and self._native.numbers == other._native.numbers

    def __hash__(self) -> int:
        return hash(self.to_json())

    def __len__(self) -> int:
        return len(self._native.numbers)

    def __repr__(self) -> str:
        count = len(self)
        return f"<dvp.Scene {self.width} x {self.height}, {count} object{'' if count == 1 else 's'}>"

    def __reduce__(self) -> tuple[Any, ...]:
        native = self._native
        state = (native.to_json(), native.bank, native.covariance, native.numbers, native.mae, native.seconds)
        return _restore, state


def _restore(*state: Any) -> Scene:
    return Scene(_dvp.Scene.from_json(*state))


def _object(of: dict[str, Any], number: int) -> Object:
    shape = {key: value for key, value in of.items() if key not in _PLACED}
    x, y = of.get("translation", (0.0, 0.0))
    red, green, blue = of["color"]
    return Object(
        number=number,
        kind=shape["kind"],
        shape=shape,
        translation=(x, y),
        scale=of.get("scale", 1.0),
        rotation=of.get("rotation", 0.0),
        color=(red, green, blue),
        confidence=of.get("confidence", 1.0),
        known=of.get("known") or {},
        ramp=of.get("ramp"),
    )


def _columns(
    scenes: Sequence[Scene | BaseException], names: Sequence[str] | None, pixel_mm: float | None
) -> list[tuple[str, str, list[Any]]]:
    outcomes = [scene._native if isinstance(scene, Scene) else str(scene) for scene in scenes]
    called = [f"{k:05}" for k in range(len(outcomes))] if names is None else [str(name) for name in names]
    stems = [name.replace("\\", "/").rsplit("/", 1)[-1].rsplit(".", 1)[0] for name in called]
    return _dvp.columns(outcomes, list(zip(called, stems)), pixel_mm)


def measures(
    scenes: Sequence[Scene | BaseException], *, names: Sequence[str] | None = None, pixel_mm: float | None = None
) -> dict[str, list[Any]]:
    """What ``dvp fit --table`` tells of many scenes, by columns: a row per object, and one for each picture that failed, whose
    column ``error`` says why. None where a cell is empty. With ``pixel_mm``, the side of a pixel, lengths and areas come in mm as
    well. ``names`` are those of the pictures.

    >>> import dvp
    >>> sorted(dvp.measures(dvp.generate(2)))[:3]
    ['angle_deg', 'angle_sd_deg', 'area_px2']
    """
    return {name: values for name, _, values in _columns(scenes, names, pixel_mm)}


def table(
    scenes: Sequence[Scene | BaseException], *, names: Sequence[str] | None = None, pixel_mm: float | None = None
) -> pa.Table:
    """:func:`measures` as a table of pyarrow: texts are strings, counts int64, others float64."""
    try:
        import pyarrow
    except ImportError as error:
        raise ImportError("dvp.table needs pyarrow: pip install pyarrow; dvp.measures gives the same columns without") from error
    types = {"text": pyarrow.string(), "count": pyarrow.int64(), "number": pyarrow.float64()}
    columns = _columns(scenes, names, pixel_mm)
    return pyarrow.table({name: pyarrow.array(values, types[kind]) for name, kind, values in columns})
