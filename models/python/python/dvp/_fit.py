"""Pictures to scenes."""

from __future__ import annotations

import functools
import os
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any, TypedDict

from . import _dvp
from ._dvp import DvpError
from ._inputs import Bank, Picture, bank_text, labels, source, stem_of
from ._scene import Scene

if TYPE_CHECKING:
    from typing_extensions import Unpack


class Options(TypedDict, total=False):
    """The options of :class:`Fitter`."""

    bank: Bank | None
    method: str
    max_objects: int | None
    objects: int | None
    start: str | os.PathLike[str] | None
    model: str | os.PathLike[str] | None
    seed: int
    compositing: str | None
    max_pixels: int


#: Most pixels of a picture unless the user says otherwise: a square of 4096.
MAX_PIXELS = 1 << 24


class Fitter:
    """A method made ready, with its memory: what :func:`fit` and :func:`fit_many` run, for those who call them again and again.

    The options are those of ``dvp fit``:

    ``bank``
        Known shapes: ``"mdshr"`` (heart, square, ellipse), the path of a bank file, or names with rows (a, b, c, d) of
        descriptors each. None: shapes are found, too.
    ``method``
        ``"segment"``, or the paper's ``"opt-iter"``, ``"opt-p"``, ``"rand-opt-p"``, or its rival ``"live"`` (``"live-published"``).
    ``max_objects``
        Most objects per picture: those stay without which most of it would be unexplained. None: 256.
    ``objects``
        Objects per picture, for ``opt-iter`` and ``rand-opt-p``, which cannot tell; for ``live`` the most. None: 4, for
        ``live`` 8, for ``live-published`` 5.
    ``start``
        None, ``"net"`` (what a network sees) or, for ``opt-p``, a folder of STEM.json.
    ``model``
        Weights of the network for ``start="net"``, as ``dvp train`` writes them. None: built in.
    ``seed``
        Number that random starts are drawn from, for ``rand-opt-p``.
    ``compositing``
        ``"over"`` or ``"blend"``: how overlapping objects mix. None: as the picture shows.
    ``max_pixels``
        Largest picture that is taken.

    >>> import dvp
    >>> fitter = dvp.Fitter(bank="mdshr")
    >>> scene = dvp.generate(seed=3)[0]
    >>> len(fitter.fit(scene.render())) == len(scene)
    True
    """

    def __init__(
        self,
        *,
        bank: Bank | None = None,
        method: str = "segment",
        max_objects: int | None = None,
        objects: int | None = None,
        start: str | os.PathLike[str] | None = None,
        model: str | os.PathLike[str] | None = None,
        seed: int = 1234,
        compositing: str | None = None,
        max_pixels: int = MAX_PIXELS,
    ) -> None:
        for name, count in (("max_objects", max_objects), ("objects", objects), ("seed", seed), ("max_pixels", max_pixels)):
            if count is not None and not 0 <= count < 1 << 63:
                raise DvpError(f"{name}={count}: must be from 0 to 2**63 - 1")
        self._options: dict[str, Any] = dict(
            bank=bank,
            method=method,
            max_objects=max_objects,
            objects=objects,
            start=start,
            model=model,
            seed=seed,
            compositing=compositing,
            max_pixels=max_pixels,
        )
        start_text = "segment" if start is None else os.fspath(start)
        self._native = _dvp.Fitter(
            bank_text(bank), method, max_objects, objects, start_text, model, seed, compositing, max_pixels
        )

    def fit(
        self, picture: Picture = None, *, masks: Any = None, coded: bool | None = None, name: str | None = None
    ) -> Scene:
        """The scene of one picture; see :func:`fit`."""
        if masks is not None:
            own = None if picture is None else source(picture)[0]
            return Scene(self._native.fit_masks(labels(masks), own))
        native, is_coded = source(picture)
        stem = stem_of(picture, 0) if name is None else name
        return Scene(self._native.fit(native, stem, is_coded if coded is None else coded))

    def fit_many(
        self, pictures: Iterable[Picture], *, threads: int = 0, coded: bool | None = None, names: Sequence[str] | None = None
    ) -> list[Scene | DvpError]:
        """The scenes of many pictures; see :func:`fit_many`."""
        given = list(pictures)
        if names is not None and len(names) != len(given):
            raise DvpError(f"{len(names)} names for {len(given)} pictures")
        if not 0 <= threads <= 1024:
            raise DvpError(f"threads={threads}: must be 0 (one per core) to 1024")
        results: list[Scene | DvpError | None] = [None] * len(given)
        work: list[tuple[int, Any, str, bool]] = []
        for k, picture in enumerate(given):
            try:
                native, is_coded = source(picture)
            except DvpError as error:
                results[k] = error
                continue
            stem = stem_of(picture, k) if names is None else names[k]
            work.append((k, native, stem, is_coded if coded is None else coded))
        found = self._native.fit_many([w[1] for w in work], [w[2] for w in work], [w[3] for w in work], threads)
        for (k, *_), outcome in zip(work, found):
            results[k] = Scene(outcome) if isinstance(outcome, _dvp.Scene) else outcome
        return [result for result in results if result is not None]

    def __reduce__(self) -> tuple[Any, ...]:
        return functools.partial(Fitter, **self._options), ()


@functools.lru_cache(maxsize=1)
def _default() -> Fitter:
    return Fitter()


def _fitter(options: Options) -> Fitter:
    return Fitter(**options) if options else _default()


def fit(
    picture: Picture = None, *, masks: Any = None, coded: bool | None = None, name: str | None = None, **options: Unpack[Options]
) -> Scene:
    """Finds the objects of a picture: shapes, positions, sizes, angles, colors; what ``dvp fit`` finds.

    ``picture`` is an array (height x width, x 3 or x 4; uint8, or float from 0 to 1), the path of a file, the bytes of one, or a PIL
    image. ``coded`` says whether the pixels of an array have gone through a JPEG; files and PIL images tell themselves.
    ``name`` stands for the name of the file where a method asks for it.

    With ``masks``, a label map of another program (whole numbers, height x width, 0 the background; or the path of one), the
    outlines are those of its labels, and the picture, if there is one, gives the colors.

    All other ``options`` are those of :class:`Fitter`. Raises :class:`DvpError`, a ValueError, which says what was wrong.

    >>> import dvp, numpy
    >>> picture = numpy.full((48, 64, 3), 255, numpy.uint8)
    >>> picture[10:30, 20:50] = (200, 30, 30)
    >>> [(o.kind, o.translation) for o in dvp.fit(picture).objects]
    [('rectangle', (0.7291667, 0.41666666))]
    """
    if masks is not None and (useless := sorted(set(options) - {"max_pixels"})):
        raise DvpError(f"{', '.join(useless)}: of no use with masks, whose outlines are taken as they are; leave it away")
    return _fitter(options).fit(picture, masks=masks, coded=coded, name=name)


def fit_many(
    pictures: Iterable[Picture],
    *,
    threads: int = 0,
    coded: bool | None = None,
    names: Sequence[str] | None = None,
    **options: Unpack[Options],
) -> list[Scene | DvpError]:
    """The scenes of many pictures, in their order; the :class:`DvpError` in place of each that failed.

    Runs on ``threads`` threads, 0 for one per core, without Python's lock. Options as of :func:`fit`.

    >>> import dvp
    >>> dvp.fit_many([dvp.generate()[0].render(), "missing.png"])
    [<dvp.Scene 128 x 128, 2 objects>, DvpError('missing.png: cannot be read: ...')]
    """
    return _fitter(options).fit_many(pictures, threads=threads, coded=coded, names=names)
