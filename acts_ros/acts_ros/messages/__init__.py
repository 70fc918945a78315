# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Conversion of messages to and from serialised bytes and the types of acts_core.

In come frames, baselines, contacts and regions; out come messages or their bytes, and back.
"""

from acts_ros.messages.baseline_messages import BaselineFields, baseline_of
from acts_ros.messages.cdr import ContactFields, header_of, read_contact, sequence_of, write_contact
from acts_ros.messages.contacts_cdr import (
    ContactsFields,
    SeriesFields,
    read_contacts,
    read_series,
    write_contacts,
    write_series,
)
from acts_ros.messages.image_cdr import ImageFields, read_image, write_image
from acts_ros.messages.parsing import message_of
from acts_ros.messages.regions_cdr import RegionsFields, read_regions, write_regions
from acts_ros.messages.sample_messages import SamplesMessage, frame_of, stamp_ns_of
from acts_ros.messages.skin_frame import check_frame_id, skin_frame
from acts_ros.messages.stamps import ns_of, seconds_of, set_stamp

__all__ = [
    "BaselineFields",
    "ContactFields",
    "ContactsFields",
    "ImageFields",
    "RegionsFields",
    "SamplesMessage",
    "SeriesFields",
    "baseline_of",
    "check_frame_id",
    "frame_of",
    "header_of",
    "message_of",
    "ns_of",
    "read_contact",
    "read_contacts",
    "read_image",
    "read_regions",
    "read_series",
    "seconds_of",
    "sequence_of",
    "set_stamp",
    "skin_frame",
    "stamp_ns_of",
    "write_contact",
    "write_contacts",
    "write_image",
    "write_regions",
    "write_series",
]
