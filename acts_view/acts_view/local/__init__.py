"""A board or a recording shown without a graph: driver's reader, reconstruction and page in one process."""
