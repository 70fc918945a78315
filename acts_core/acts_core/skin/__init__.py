# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The skin: where its taxels lie, and the force response of a taxel.

In come layout files and measured force responses; out come `Layout`, `SkinPatch` and `ForceResponse`, which tell all
other packages where a taxel lies and what it reads. `RegionContact` is what a patch of a skin feels,
`TrackedBlob` a contact that is followed from image to image. `taxels_named` reads the names of broken taxels.
"""

from acts_core.skin.force import ForceResponse, MeasuredForceResponse, Response, force_table
from acts_core.skin.layout_file import MAX_PATCHES
from acts_core.skin.layouts import LAYOUTS, NO_PATCH, Layout, layout, layout_path
from acts_core.skin.region_contact import RegionContact, Vector
from acts_core.skin.skin_patch import SkinPatch
from acts_core.skin.taxel_words import TAXELS_RULE, dead_taxels_named, taxels_in_words, taxels_named
from acts_core.skin.tracked_blob import TrackedBlob

__all__ = [
    "LAYOUTS",
    "MAX_PATCHES",
    "NO_PATCH",
    "TAXELS_RULE",
    "ForceResponse",
    "Layout",
    "MeasuredForceResponse",
    "RegionContact",
    "Response",
    "SkinPatch",
    "TrackedBlob",
    "Vector",
    "dead_taxels_named",
    "force_table",
    "layout",
    "layout_path",
    "taxels_in_words",
    "taxels_named",
]
