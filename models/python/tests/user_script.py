"""A user's script, for `mypy --strict`: every public function with the types that its docs promise."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt

import dvp


def largest(path: Path) -> dvp.Object | None:
    """The object of the largest area in a picture."""
    scene: dvp.Scene = dvp.fit(path, bank={"disk": [[1, 0, 0, 1]]}, max_objects=8)
    areas: list[float] = scene.measures(pixel_mm=0.1)["area_mm2"]
    return max(zip(areas, scene.objects), key=lambda pair: pair[0])[1] if areas else None


def good(pictures: list[bytes]) -> list[dvp.Scene]:
    """The scenes of those pictures that can be read."""
    fitter = dvp.Fitter(compositing="over")
    return [scene for scene in fitter.fit_many(pictures, threads=2) if isinstance(scene, dvp.Scene)]


def main() -> None:
    truth = dvp.generate(3, seed=4, size=(64, 64))
    images: list[npt.NDArray[np.uint8]] = [scene.render() for scene in truth]
    scores: dvp.Scores = dvp.evaluate(truth, images, truth)
    rows: npt.NDArray[np.float64] = dvp.efd([[0, 0], [1, 0], [0, 1]], 4)
    labels: npt.NDArray[np.uint32] = truth[0].labels()
    try:
        dvp.fit("missing.png")
    except dvp.DvpError as error:
        print(scores["mae"], rows.shape, labels.max(), error, truth[0].objects[0].translation[0] + 1)


if __name__ == "__main__":
    main()
