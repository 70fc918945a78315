"""What each patch of a skin feels: force, centre, area, peak, spread, motion and slip.

In comes the image with its layout; out comes a `RegionContact` for every patch that is touched.
"""

from acts_recon.regions.regions import Regions

__all__ = ["Regions"]
