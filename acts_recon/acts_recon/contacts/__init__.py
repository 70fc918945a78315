# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Contacts in an image: all of them as one, and each as a track with a number that stays.

In comes an image with the uncertainty of its taxels; out come places, forces and areas, each with its uncertainty, and
the tracks of the contacts from frame to frame.
"""

from acts_core.skin import TrackedBlob
from acts_recon.contacts.blob_config import BlobConfig
from acts_recon.contacts.blob_kernels import MAX_BLOBS
from acts_recon.contacts.blob_tracker import BlobTracker
from acts_recon.contacts.contact import Contact
from acts_recon.contacts.contact_finder import ContactFinder

__all__ = ["MAX_BLOBS", "BlobConfig", "BlobTracker", "Contact", "ContactFinder", "TrackedBlob"]
