"""`acts evaluate impacts` and `acts evaluate ricochet`: balls on the simulated skin, without board and wires."""
