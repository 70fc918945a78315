"""Two machines on one: network namespaces and a cable between them that can be slow, lossy or cut."""
