"""Two simulated machines: network namespaces, and a cable between them that can be slow, lossy or cut."""
