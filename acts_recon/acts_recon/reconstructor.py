"""From the samples of one frame to the full image and the contact in it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from acts_core.array import COUNT_MAX, ArrayGeometry
from acts_core.errors import ArrayError
from acts_core.force import ForceResponse, MeasuredForceResponse, force_table
from acts_core.layouts import Layout
from acts_core.settings import setting, validate
from acts_recon import contact_kernels
from acts_recon import fastomp_kernels as kernels
from acts_recon.contact import NO_CONTACT, Contact
from acts_recon.dictionary import Dictionary
from acts_recon.fastomp import SPARSITY_RATIO
from acts_recon.patches import patch_layout


@dataclass(frozen=True)
class ReconstructorConfig:
    """Settings of the recovery; the defaults are the paper's ("Sparse Recovery and Tactile Reconstruction")."""

    touch_counts: int = setting(60, "counts above which a taxel is pressed; others are 0", minimum=0, maximum=COUNT_MAX)
    patch_step: int = setting(4, "distance of neighbouring patches in taxels", minimum=1, maximum=64)
    sparsity_ratio: float = setting(SPARSITY_RATIO, "atoms per measured taxel of a patch", minimum=0.01, maximum=1.0)
    keep_measured: bool = setting(True, "measured taxels keep their measured value in the image")

    def __post_init__(self) -> None:
        validate(self)


class Reconstructor:
    """Recovers frame after frame without allocating; everything is checked and compiled before the first one.

    Parameters
    ----------
    geometry : ArrayGeometry
        Of the picture; without a layout that is the matrix itself.
    dictionary : Dictionary
    config : ReconstructorConfig
    response : ForceResponse or MeasuredForceResponse
        From counts to newtons.
    layout : Layout, optional
        Where the taxels of the matrix lie in the picture. `step` takes matrix indices; patches are laid over the
        picture, where neighbours are neighbours, and `image` and contacts are the picture's.

    Raises
    ------
    ArrayError
        When the dictionary's patches do not fit the array, or the layout is of another size.
    """

    def __init__(
        self,
        geometry: ArrayGeometry,
        dictionary: Dictionary,
        config: ReconstructorConfig | None = None,
        response: ForceResponse | MeasuredForceResponse | None = None,
        layout: Layout | None = None,
    ) -> None:
        self.geometry = geometry
        self.config = config or ReconstructorConfig()
        self.response = response or ForceResponse()
        self._force_n = force_table(self.response)
        self._matrix_size = (geometry.rows, geometry.cols)
        self._places: NDArray[np.uint16] | None = None
        if layout is not None:
            self._places = _place_table(layout, geometry)
            self._matrix_size = (layout.matrix_rows, layout.matrix_cols)
        patches = patch_layout(geometry.rows, geometry.cols, size=dictionary.patch_size, step=self.config.patch_step)
        n_pixels = dictionary.patch_size**2
        self._model = (
            kernels.in_blocks(dictionary.atoms),
            np.ascontiguousarray(dictionary.atoms.T),
            patches.taxels,
            patches.overlap,
            patches.entry_start,
            patches.entry_patch,
            patches.entry_pixel,
        )
        self._workspace = kernels.Workspace(geometry.size, patches.n_patches, n_pixels).arrays()
        self._flat = np.zeros(geometry.size, dtype=np.float32)
        self._results = np.zeros(contact_kernels.RESULTS)
        self.image: NDArray[np.float32] = self._flat.reshape(geometry.rows, geometry.cols)
        """The image of the last frame [counts, 0 to 1023]; np.ndarray [shape=(rows, cols), dtype=float32].

        Overwritten by the next frame: copy what is to be kept.
        """
        self._warm_up()

    def step(self, indices: NDArray[np.uint16], counts: NDArray[np.uint16]) -> Contact:
        """Recover one frame into `image` and find the contact in it.

        Parameters
        ----------
        indices : np.ndarray [shape=(m,), dtype=uint16]
            Row-major taxel indices of the matrix, none twice; at least one.
        counts : np.ndarray [shape=(m,), dtype=uint16]
            What was measured there, 0 to 1023.

        Raises
        ------
        ArrayError
            When the frame does not fit the array or holds impossible values. `image` then is still the previous one.
        """
        if indices.dtype != np.uint16 or counts.dtype != np.uint16 or indices.ndim != 1 or counts.ndim != 1:
            raise ArrayError(f"indices {_kind(indices)} and counts {_kind(counts)}: needed are two rows of uint16")
        if indices.size != counts.size or indices.size == 0:
            raise ArrayError(f"{indices.size} indices and {counts.size} counts: needed are as many, at least one")
        config = self.config
        code = kernels.recover_image(
            *self._model,
            indices if self._places is None else self._places[indices],
            counts,
            config.touch_counts,
            COUNT_MAX,
            config.sparsity_ratio,
            config.keep_measured,
            *self._workspace,
            self._flat,
        )
        if code != kernels.OK:
            raise ArrayError(self._reason(code, indices, counts))
        return self._contact()

    def _contact(self) -> Contact:
        geometry, results = self.geometry, self._results
        contact_kernels.find_contact(
            self._flat,
            geometry.cols,
            float(self.config.touch_counts),
            self._force_n,
            results,
        )
        col, row, force_n, peak, pressed, col_square, row_square = results.tolist()
        if pressed == 0:
            return NO_CONTACT
        x_pitch_m, y_pitch_m = geometry.pitch_m, geometry.pitch_y_m
        return Contact(
            in_contact=True,
            x_m=(col - (geometry.cols - 1) / 2) * x_pitch_m,
            y_m=((geometry.rows - 1) / 2 - row) * y_pitch_m,
            force_n=force_n,
            peak_counts=peak,
            area_m2=pressed * x_pitch_m * y_pitch_m,
            active_taxels=int(pressed),
            spread_m=(col_square * x_pitch_m**2 + row_square * y_pitch_m**2) ** 0.5,
        )

    def _reason(self, code: int, indices: NDArray[np.uint16], counts: NDArray[np.uint16]) -> str:
        rows, cols = self._matrix_size
        if code == kernels.INDEX_OUT_OF_RANGE:
            return f"index {indices.max()}: an array of {rows} x {cols} has 0 to {rows * cols - 1}"
        if code == kernels.COUNT_OUT_OF_RANGE:
            return f"count {counts.max()}: the board reads 0 to {COUNT_MAX}"
        values, times = np.unique(indices, return_counts=True)
        return f"index {values[np.argmax(times)]} occurs twice in a frame; each taxel is measured at most once"

    def _warm_up(self) -> None:
        """Compile, or load from the cache, what the first frame would otherwise wait seconds for."""
        everything = np.arange(self.geometry.size, dtype=np.uint16)
        self.step(everything[:1], np.full(1, COUNT_MAX, dtype=np.uint16))
        self.step(everything[:1], np.zeros(1, dtype=np.uint16))


def _place_table(layout: Layout, geometry: ArrayGeometry) -> NDArray[np.uint16]:
    """Places by matrix index; an index that is out of range stays so. Shape (65536,), uint16."""
    if (layout.rows, layout.cols) != (geometry.rows, geometry.cols):
        raise ArrayError(
            f"geometry of {geometry.rows} x {geometry.cols}: the layout {layout.name} is {layout.rows} x {layout.cols}"
        )
    table = np.arange(2**16, dtype=np.uint16)
    table[: layout.places.size] = layout.places
    return table


def _kind(array: NDArray) -> str:
    return f"of shape {array.shape}, {array.dtype}"
