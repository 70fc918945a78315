# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The parameters of the reconstruction node, and what is built from them."""

from __future__ import annotations

from dataclasses import dataclass, make_dataclass

from acts_core.array import COUNT_MAX, MAX_SIDE, ArrayGeometry
from acts_core.errors import SettingsError
from acts_core.files import path_of
from acts_core.runtime import RealtimeConfig
from acts_core.settings import Changeable, default_of, describe, part_of, refuse_doubles, setting
from acts_core.skin import LAYOUTS, ForceResponse, Layout, MeasuredForceResponse, Response, layout, layout_path
from acts_recon.classifiers import AUTO, CLASSIFIERS, ObjectRecogniser, classifier_named
from acts_recon.contacts import BlobConfig
from acts_recon.fusion import FusionConfig
from acts_recon.images import LEAST_NOISE_COUNTS, LONGEST_PAUSE_S, NOISE_COUNTS, DeadTaxelsConfig
from acts_recon.impacts import ImpactConfig, ImpactDetector
from acts_recon.methods import METHODS, Recovery, SkinSetup
from acts_recon.objects import load_object_library
from acts_recon.outlines import OutlinesConfig, OutlineTracer
from acts_recon.regions import Regions, SharpnessConfig
from acts_recon.slip import SlipConfig
from acts_recon.sparse import ReconstructorConfig
from acts_recon.spectra import SpectraConfig, SpectrumAnalyser

_ARRAY = ArrayGeometry()
_RESPONSE = ForceResponse()


@dataclass(frozen=True)
class ReconstructionConfig(
    RealtimeConfig, SlipConfig, SharpnessConfig, ImpactConfig, SpectraConfig, OutlinesConfig, DeadTaxelsConfig
):
    """The node's own parameters; those of methods and classifiers come with `ReconstructionSettings`."""

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
        "; ".join(f"{name}: {kind.summary}" for name, kind in METHODS.items()),
        choices=tuple(METHODS),
    )
    noise_counts: float = setting(
        default_of(FusionConfig, "noise_counts"),
        "noise of a reading, its standard deviation, where the topic baseline does not have it [counts]; 0: not known, "
        "then untouched skin is shown as what it reads in the mean; contact, contacts, impacts, spectra, outlines and "
        "regions use it even with a baseline, and 2 counts for 0: set it where the skin is noisier",
        minimum=0.0,
        maximum=100.0,
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
        "largest rate of the topics image and contacts_view, and of those that begin with view/, but for "
        "view/contact_series with 1024 contacts [Hz]",
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
        "topic contacts: a pressed taxel is released at this many counts below touch_counts",
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
    impacts: bool = setting(True, "offer the topic impacts, which costs nothing while nobody listens")
    spectra: bool = setting(True, "offer the topic spectra, which costs nothing while nobody listens")
    spectra_rate_hz: float = setting(
        2.0,
        "largest rate of the topic spectra [Hz]; 0: as often as they can be made",
        minimum=0.0,
        maximum=100.0,
        changeable=Changeable.RUNNING,
    )
    outlines: bool = setting(True, "offer the topic outlines, which costs nothing while nobody listens")
    outlines_rate_hz: float = setting(
        50.0,
        "largest rate of the topic outlines while no contact is younger than outlines_fast_s [Hz]; 0: every frame",
        minimum=0.0,
        maximum=1000.0,
        changeable=Changeable.RUNNING,
    )
    regions_rate_hz: float = setting(
        0.0,
        "largest rate of the topic regions [Hz]; 0: every frame; from 2 down motion and slip are never found",
        minimum=0.0,
        maximum=1000.0,
        changeable=Changeable.RUNNING,
    )
    regions_slip_rate_hz: float = setting(
        250.0,
        "topic regions: motion and slip are looked for so often at most [Hz]; 0: in every frame; otherwise at least 2",
        minimum=0.0,
        maximum=1000.0,
    )
    object_library: str = setting(
        "", "path of an object library made by `acts library`, to publish the topic object; empty: off"
    )
    object_classifier: str = setting(
        AUTO,
        "topic object: which classifier; auto: fused_image where the method knows how sure it is, otherwise src",
        choices=(AUTO, *CLASSIFIERS),
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
        SharpnessConfig.__post_init__(self)
        layout_path(self.layout)  # refuses what is neither a name nor a path
        self.dead(self.rows, self.cols)  # refuses what are no taxels
        # Images that are farther apart than `LONGEST_PAUSE_S` are not compared.
        if 0.0 < self.regions_slip_rate_hz < 1.0 / LONGEST_PAUSE_S:
            raise SettingsError(
                f"regions_slip_rate_hz = {self.regions_slip_rate_hz:g}: allowed are 0, for every frame, and "
                f"{1.0 / LONGEST_PAUSE_S:g} and more: slip would never be found"
            )
        for name in self.unused:
            value = getattr(self, name)
            if isinstance(value, str):
                raise SettingsError(
                    f"{name} = {value!r}: the method {self.method} uses none; "
                    f"choose {_user_of(name)}, or leave {name} out"
                )

    @property
    def unused(self) -> tuple[str, ...]:
        """Parameters that were given and that neither the method nor its classifier uses."""
        used = {*describe(METHODS[self.method].Config), *describe(self.classifier.Config)}
        return tuple(
            name
            for part in (METHODS, CLASSIFIERS)
            for kind in part.values()
            for name in describe(kind.Config)
            if name not in used and getattr(self, name) != default_of(type(self), name)
        )

    @property
    def classifier(self) -> type[ObjectRecogniser]:
        """The classifier that `object_classifier` names.

        Raises
        ------
        SettingsError
            When it does not go with the method.
        """
        return classifier_named(self.object_classifier, METHODS[self.method])

    def arranged(self) -> Layout:
        """The layout.

        Raises
        ------
        ArrayError, SettingsError
            As of `acts_core.skin.layouts.layout`.
        """
        return layout(self.layout, self.rows, self.cols)

    def skin(self) -> SkinSetup:
        """What method and classifier are told of the skin.

        Raises
        ------
        ArrayError, SettingsError
            As of `arranged`, and when the force response cannot be used.
        """
        arranged = self.arranged()
        geometry = arranged.geometry(self.pitch_m, self.row_pitch_m)
        placed, dead = None if arranged.is_matrix else arranged, self.dead(self.rows, self.cols)
        return SkinSetup(geometry, placed, self._response(), self.touch_counts, self.noise_counts, dead)

    def recovery(self) -> Recovery:
        """Make the method that `method` names ready for the first frame; takes seconds when not yet compiled.

        Raises
        ------
        DictionaryError
            When the dictionary cannot be used.
        ArrayError
            When it, or the layout, does not fit the array.
        SettingsError
            When the force response cannot be used.
        """
        kind, skin = METHODS[self.method], self.skin()
        return Recovery(kind(skin, part_of(kind.Config, self)), skin)

    def _response(self) -> Response:
        if self.force_response:
            return MeasuredForceResponse.from_file(path_of(self.force_response, error=SettingsError))
        return ForceResponse(self.force_full_scale_counts, self.force_dead_n, self.force_half_n)

    def blob_config(self) -> BlobConfig:
        """How contacts are told from one another and followed."""
        return BlobConfig(
            touch_counts=self.touch_counts,
            hysteresis_counts=self.contacts_hysteresis_counts,
            bridge_s=self.contacts_bridge_s,
            memory_s=self.contacts_memory_s,
            noise_counts=self.noise_counts or NOISE_COUNTS,
        )

    def impact_detector(self, recovery: Recovery) -> ImpactDetector:
        """Make ready what tells of impacts.

        Parameters
        ----------
        recovery : Recovery
            What `recovery` returned.
        """
        return ImpactDetector(
            recovery.geometry,
            recovery.response,
            self.blob_config(),
            part_of(ImpactConfig, self),
            recovery.borders,
            stood_on=self.arranged().stood_on,
        )

    def spectrum_analyser(self, recovery: Recovery) -> SpectrumAnalyser:
        """Make ready what tells how contacts vibrate.

        Parameters
        ----------
        recovery : Recovery
            What `recovery` returned.
        """
        skin = recovery.skin
        return SpectrumAnalyser(
            skin.geometry,
            skin.response,
            touch_counts=float(self.touch_counts),
            noise_counts=skin.assumed_noise_counts,
            config=part_of(SpectraConfig, self),
            layout=skin.layout,
            dead=recovery.dead,
        )

    def outline_tracer(self, recovery: Recovery) -> OutlineTracer:
        """Make ready what finds the outlines of contacts.

        Parameters
        ----------
        recovery : Recovery
            What `recovery` returned.
        """
        skin = recovery.skin
        return OutlineTracer(
            skin.geometry,
            skin.response,
            touch_counts=float(self.touch_counts),
            noise_counts=skin.assumed_noise_counts,
            config=part_of(OutlinesConfig, self),
            layout=skin.layout,
            dead=None if recovery.dead is None else recovery.dead.in_picture,
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
        return Regions(
            arranged.spaced(self.pitch_m, self.row_pitch_m),
            recovery.response,
            touch_counts=float(self.touch_counts),
            # With next to no noise anything would be slip.
            noise_counts=max(recovery.skin.assumed_noise_counts, LEAST_NOISE_COUNTS),
            slip=part_of(SlipConfig, self),
            slip_rate_hz=self.regions_slip_rate_hz,
            sharpness=part_of(SharpnessConfig, self),
            dead=recovery.dead,
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
        library = load_object_library(path_of(self.object_library, error=SettingsError), shape=(self.rows, self.cols))
        kind = self.classifier
        return kind(library, part_of(kind.Config, self), recovery.skin, recovery.method)


def _user_of(name: str) -> str:
    """Which method or classifier uses a parameter, in words."""
    for word, part in (("method", METHODS), ("object_classifier", CLASSIFIERS)):
        for user, kind in part.items():
            if name in describe(kind.Config):
                return f"{word} {user}"
    raise AssertionError(name)


def settings_class() -> type:
    """The node's own parameters, and those of every method and every classifier there is.

    Raises
    ------
    SettingsError
        When two of them have a parameter of one name.
    """
    configs = [kind.Config for part in (METHODS, CLASSIFIERS) for kind in part.values()]
    configs = list(dict.fromkeys(configs))
    refuse_doubles(ReconstructionConfig, *configs)
    # The fields of the last base come first.
    bases = (*reversed(configs), ReconstructionConfig)
    checks = {"__post_init__": ReconstructionConfig.__post_init__}
    return make_dataclass("ReconstructionSettings", [], bases=bases, namespace=checks, frozen=True)


ReconstructionSettings = settings_class()
"""Parameters of the node ``reconstruction``."""
