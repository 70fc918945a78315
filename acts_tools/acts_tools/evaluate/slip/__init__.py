"""How soon slip is told, on recordings of full frames and on sampled ones."""
