"""The parameters of the reconstruction node, and what is built from them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from acts_core.array import COUNT_MAX, MAX_SIDE, ArrayGeometry
from acts_core.errors import SettingsError
from acts_core.runtime import RealtimeConfig
from acts_core.settings import Changeable, default_of, setting
from acts_core.skin import LAYOUTS, ForceResponse, Layout, MeasuredForceResponse, layout, layout_path
from acts_recon.contacts import BlobConfig
from acts_recon.fusion import FusionConfig, FusionEstimator
from acts_recon.objects import (
    Classifier,
    ClassifierConfig,
    FusedObjects,
    ImageClassifier,
    ImageClassifierConfig,
    ObjectRecogniser,
    PerFrameObjects,
    load_object_library,
)
from acts_recon.recovery import METHODS, FusedRecovery, PerFrameRecovery, Recovery
from acts_recon.regions import Regions
from acts_recon.slip import SlipConfig
from acts_recon.sparse import Reconstructor, ReconstructorConfig, load_dictionary, shipped_dictionary_path

_ARRAY = ArrayGeometry()
_RESPONSE = ForceResponse()

# Of a reading in whole counts.
_LEAST_NOISE_COUNTS = 0.3

# Parameters that one method alone uses.
_OF_METHOD = {
    "fusion": ("object_touch_counts", "object_src_weight"),
    "per_frame": ("dictionary", "patch_step", "sparsity_ratio", "keep_measured", "object_columns"),
}


@dataclass(frozen=True)
class ReconstructionSettings(RealtimeConfig, SlipConfig):
    """Parameters of the node ``reconstruction``."""

    rows: int = setting(_ARRAY.rows, "rows of the array", minimum=1, maximum=MAX_SIDE)
    cols: int = setting(_ARRAY.cols, "columns of the array", minimum=1, maximum=MAX_SIDE)
    layout: str = setting(
        "square",
        f"how the matrix of taxels lies on the skin: {', '.join(LAYOUTS)}, or the path of a layout file; images and "
        "contacts follow it",
    )
    pitch_m: float = setting(
        0.0,
        "distance between neighbouring columns of the image [m]; 0: that of the layout",
        minimum=0.0,
        maximum=1.0,
    )
    row_pitch_m: float = setting(
        0.0,
        "distance between neighbouring rows of the image [m]; 0: as pitch_m, the layout's where that is 0",
        minimum=0.0,
        maximum=1.0,
    )
    method: str = setting(
        "fusion",
        "fusion: the image is estimated from all samples so far; per_frame: from each frame alone, as in the paper, "
        "with dictionary, patch_step, sparsity_ratio and keep_measured",
        choices=METHODS,
    )
    noise_counts: float = setting(
        default_of(FusionConfig, "noise_counts"),
        "standard deviation of a reading about the truth, for fusion [counts]",
        minimum=0.0,
        maximum=100.0,
    )
    dictionary: str = setting(
        "", "path of a dictionary file made by `acts train`, for per_frame; empty for the shipped one"
    )
    touch_counts: int = setting(
        default_of(ReconstructorConfig, "touch_counts"),
        "ADC counts above which a taxel is pressed; others are taken as 0",
        minimum=0,
        maximum=COUNT_MAX,
    )
    subtract_baseline: bool = setting(
        True, "subtract what the topic baseline says a taxel reads untouched; nothing while there is none"
    )
    patch_step: int = setting(
        default_of(ReconstructorConfig, "patch_step"),
        "distance of neighbouring patches in taxels",
        minimum=1,
        maximum=64,
    )
    sparsity_ratio: float = setting(
        default_of(ReconstructorConfig, "sparsity_ratio"),
        "atoms per measured taxel of a patch",
        minimum=0.01,
        maximum=1.0,
    )
    keep_measured: bool = setting(True, "measured taxels keep their measured value in the image")
    force_full_scale_counts: float = setting(
        _RESPONSE.full_scale_counts, "counts of a taxel at infinite force", minimum=1.0, maximum=float(COUNT_MAX)
    )
    force_dead_n: float = setting(_RESPONSE.dead_n, "largest force that reads 0 [N]", minimum=0.0, maximum=100.0)
    force_half_n: float = setting(
        _RESPONSE.half_n, "force above it that reads half of full scale [N]", minimum=1e-6, maximum=1000.0
    )
    force_response: str = setting(
        "",
        "path of a measured force response, csv or npz of newtons and counts, used instead of the three force_* values",
    )
    image_raw_rate_hz: float = setting(
        0.0,
        "largest rate of the topic image_raw [Hz]; 0: every frame",
        minimum=0.0,
        maximum=1000.0,
        changeable=Changeable.RUNNING,
    )
    image_rate_hz: float = setting(
        30.0,
        "largest rate of the topics image, view/image_raw and view/confidence [Hz]",
        minimum=0.1,
        maximum=1000.0,
        changeable=Changeable.RUNNING,
    )
    image_scale: int = setting(10, "pixels along a taxel's side in the topic image", minimum=1, maximum=64)
    image_full_scale_counts: float = setting(
        float(COUNT_MAX),
        "counts shown white in the topic image",
        minimum=1.0,
        maximum=float(COUNT_MAX),
        changeable=Changeable.RUNNING,
    )
    contacts_hysteresis_counts: int = setting(
        default_of(BlobConfig, "hysteresis_counts"),
        "topic contacts: a pressed taxel ceases to be at so many counts below touch_counts",
        minimum=0,
        maximum=COUNT_MAX,
    )
    contacts_bridge_s: float = setting(
        default_of(BlobConfig, "bridge_s"),
        "topic contacts: a contact that comes back within this time keeps its number [s]",
        minimum=0.0,
        maximum=10.0,
    )
    contacts_memory_s: float = setting(
        default_of(BlobConfig, "memory_s"),
        "topic contacts: contacts that became one get their numbers back within this time [s]",
        minimum=0.0,
        maximum=1000.0,
    )
    regions_rate_hz: float = setting(
        0.0,
        "largest rate of the topic regions [Hz]; 0: every frame",
        minimum=0.0,
        maximum=1000.0,
        changeable=Changeable.RUNNING,
    )
    regions_slip_rate_hz: float = setting(
        250.0,
        "topic regions: motion and slip are looked for so often at most [Hz]; 0: in every frame",
        minimum=0.0,
        maximum=1000.0,
    )
    object_library: str = setting(
        "", "path of an object library made by `acts library`, to publish the topic object; empty: off"
    )
    object_touch_counts: int = setting(
        default_of(ImageClassifierConfig, "touch_counts"),
        "topic object, fusion: counts above which a taxel is pressed, as when the library was made; per_frame takes "
        "touch_counts",
        minimum=0,
        maximum=COUNT_MAX,
    )
    object_src_weight: float = setting(
        default_of(ImageClassifierConfig, "src_weight"),
        "topic object, fusion: weight of SRC on a resting image against the comparison of images; 0: none",
        minimum=0.0,
        maximum=100.0,
    )
    object_columns: int = setting(
        default_of(ClassifierConfig, "max_columns"),
        "topic object, per_frame: library columns that explain a frame at most; 0: a quarter as many as samples; 2 as "
        "on the board",
        minimum=0,
        maximum=1024,
    )
    object_rate_hz: float = setting(
        0.0,
        "largest rate of the topic object [Hz]; 0: every frame",
        minimum=0.0,
        maximum=1000.0,
        changeable=Changeable.RUNNING,
    )

    def __post_init__(self) -> None:
        RealtimeConfig.__post_init__(self)
        layout_path(self.layout)  # refuses what is neither a name nor a path
        if self.dictionary and self.method != "per_frame":
            raise SettingsError(
                f"dictionary = {self.dictionary!r}: the method {self.method} uses none; "
                "choose method per_frame, or leave the dictionary out"
            )

    @property
    def unused(self) -> tuple[str, ...]:
        """Parameters that were given and that the method does not use."""
        return tuple(
            name
            for method, names in _OF_METHOD.items()
            for name in names
            if method != self.method and getattr(self, name) != default_of(type(self), name)
        )

    def arranged(self) -> Layout:
        """The layout.

        Raises
        ------
        ArrayError, SettingsError
            As of `acts_core.skin.layouts.layout`.
        """
        return layout(self.layout, self.rows, self.cols)

    def reconstructor(self) -> Reconstructor:
        """Load the dictionary and make everything ready for the first frame; takes seconds when not yet compiled.

        Raises
        ------
        DictionaryError
            When the dictionary cannot be used.
        ArrayError
            When it, or the layout, does not fit the array.
        SettingsError
            When the force response cannot be used.
        """
        path = Path(self.dictionary).expanduser() if self.dictionary else shipped_dictionary_path()
        arranged = self.arranged()
        return Reconstructor(
            arranged.geometry(self.pitch_m, self.row_pitch_m),
            load_dictionary(path),
            ReconstructorConfig(
                touch_counts=self.touch_counts,
                patch_step=self.patch_step,
                sparsity_ratio=self.sparsity_ratio,
                keep_measured=self.keep_measured,
            ),
            self._response(),
            None if arranged.is_matrix else arranged,
        )

    def recovery(self) -> Recovery:
        """Make the method that `method` names ready for the first frame; takes seconds when not yet compiled.

        Raises
        ------
        DictionaryError, ArrayError, SettingsError
            As `reconstructor`.
        """
        if self.method == "per_frame":
            return PerFrameRecovery(self.reconstructor())
        arranged = self.arranged()
        estimator = FusionEstimator(
            arranged.geometry(self.pitch_m, self.row_pitch_m),
            FusionConfig(noise_counts=self.noise_counts),
            None if arranged.is_matrix else arranged,
        )
        return FusedRecovery(estimator, self._response(), self.touch_counts)

    def _response(self) -> ForceResponse | MeasuredForceResponse:
        if self.force_response:
            return ForceResponse.from_file(Path(self.force_response))
        return ForceResponse(self.force_full_scale_counts, self.force_dead_n, self.force_half_n)

    def blob_config(self) -> BlobConfig:
        """How contacts are told from one another and followed."""
        return BlobConfig(
            touch_counts=self.touch_counts,
            hysteresis_counts=self.contacts_hysteresis_counts,
            bridge_s=self.contacts_bridge_s,
            memory_s=self.contacts_memory_s,
            noise_counts=self.noise_counts,
        )

    def regions(self, recovery: Recovery) -> Regions | None:
        """Make ready what finds the contact on each patch; None where the skin is one patch that lies on no link.

        Parameters
        ----------
        recovery : Recovery
            What `recovery` returned.
        """
        arranged = self.arranged()
        if len(arranged.patches) == 1 and not arranged.patches[0].link:
            return None
        # Noise of 0 would let anything be slip.
        noise_counts = max(self.noise_counts, _LEAST_NOISE_COUNTS)
        return Regions(
            arranged, recovery.response, self.touch_counts, noise_counts, self, slip_rate_hz=self.regions_slip_rate_hz
        )

    def recogniser(self, recovery: Recovery) -> ObjectRecogniser | None:
        """Load the object library and make everything ready for the first frame; None where there is to be none.

        Parameters
        ----------
        recovery : Recovery
            What `recovery` returned: it leaves behind what objects are recognised by.

        Raises
        ------
        ObjectLibraryError
            When the library cannot be used, or is for another array.
        """
        if not self.object_library:
            return None
        library = load_object_library(Path(self.object_library).expanduser(), shape=(self.rows, self.cols))
        arranged = self.arranged()
        if recovery.sigma is None or recovery.age_s is None:
            config = ClassifierConfig(touch_counts=self.touch_counts, max_columns=self.object_columns)
            return PerFrameObjects(Classifier(library, config))
        return FusedObjects(
            ImageClassifier(
                library,
                ImageClassifierConfig(touch_counts=self.object_touch_counts, src_weight=self.object_src_weight),
                recovery.response,
            ),
            recovery.image,
            recovery.sigma,
            recovery.age_s,
            None if arranged.is_matrix else arranged,
        )
