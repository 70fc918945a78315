# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Rendered pictures of the simulated hand, without a display (EGL)."""

from __future__ import annotations

import mujoco
import numpy as np
from numpy.typing import NDArray

from acts_core.errors import ActsError
from acts_sim.hand import HandWorld

_MAX_GEOMS = 2500
_DOT_M = 0.0009
_LOOK_AT_M = (-0.005, -0.03, -0.045)

# Azimuth and elevation [deg] of the camera while the palm faces up (the scene's up is -z of the palm).
VIEWS = {"side": (100.0, 12.0), "above": (140.0, 55.0), "fingers": (190.0, 20.0), "front": (20.0, 35.0)}


class HandPicture:
    """Renders a world.

    Parameters
    ----------
    world : HandWorld
    width, height : int
        Size of the pictures [pixels], up to 1280 x 960.

    Raises
    ------
    ActsError
        When EGL is not available.
    """

    def __init__(self, world: HandWorld, width: int = 800, height: int = 600) -> None:
        self._world = world
        self._width, self._height = width, height
        try:
            # Imported late, because it loads the graphics library.
            from mujoco.egl import GLContext

            self._gl = GLContext(width, height)
            self._gl.make_current()
            self._context = mujoco.MjrContext(world.model, mujoco.mjtFontScale.mjFONTSCALE_100)
        except (ImportError, AttributeError, RuntimeError, mujoco.FatalError) as error:
            raise ActsError(f"cannot render without a display ({error}); EGL is needed") from error
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN, self._context)
        self._scene = mujoco.MjvScene(world.model, _MAX_GEOMS)

    def close(self) -> None:
        """Release the memory of the graphics library."""
        self._context.free()
        self._gl.free()

    def take(
        self, view: str = "above", counts: NDArray[np.float64] | None = None, distance_m: float = 0.36
    ) -> NDArray[np.uint8]:
        """Render the present state on white; np.ndarray [shape=(height, width, 3), dtype=uint8].

        Parameters
        ----------
        view : str
            One of `VIEWS`.
        counts : np.ndarray [shape=(taxels,), dtype=float64], optional
            Counts of the taxels, in the order of the matrix; by default those of the world.
        distance_m : float
            Distance of the camera from the hand's centre [m].
        """
        world, scene = self._world, self._scene
        self._gl.make_current()
        camera = mujoco.MjvCamera()
        camera.type = mujoco.mjtCamera.mjCAMERA_FREE
        camera.lookat[:] = _LOOK_AT_M
        camera.distance = distance_m
        camera.azimuth, camera.elevation = VIEWS[view]
        option, perturbation = mujoco.MjvOption(), mujoco.MjvPerturb()
        mujoco.mjv_updateScene(world.model, world.data, option, perturbation, camera, mujoco.mjtCatBit.mjCAT_ALL, scene)
        self._turn_upright(camera)
        self._add_taxels(world.counts if counts is None else counts)
        viewport = mujoco.MjrRect(0, 0, self._width, self._height)
        mujoco.mjr_render(viewport, scene, self._context)
        picture = np.empty((self._height, self._width, 3), dtype=np.uint8)
        depth = np.empty((self._height, self._width), dtype=np.float32)
        mujoco.mjr_readPixels(picture, depth, viewport, self._context)
        picture[depth >= 1.0] = 255
        return picture[::-1]

    def _turn_upright(self, camera: mujoco.MjvCamera) -> None:
        """Rotate the camera so that gravity points down: the model's frame is the palm's."""
        up = -self._world.down
        forward_flat = np.array([1.0, 0.0, 0.0]) if abs(up[0]) < 0.9 else np.array([0.0, 0.0, -1.0])
        left_flat = np.cross(up, forward_flat)
        azimuth, elevation = np.radians(camera.azimuth), np.radians(camera.elevation)
        outward = np.cos(elevation) * (np.cos(azimuth) * forward_flat + np.sin(azimuth) * left_flat)
        outward = outward + np.sin(elevation) * up
        side = np.cross(up, outward)
        side /= np.linalg.norm(side)
        position = np.array(_LOOK_AT_M) + camera.distance * outward
        for eye in self._scene.camera:
            eye.pos[:] = position
            eye.forward[:] = -outward
            eye.up[:] = np.cross(outward, side)
        for light in range(self._scene.nlight):
            self._scene.lights[light].pos[:] = position
            self._scene.lights[light].dir[:] = -outward

    def _add_taxels(self, counts: NDArray[np.float64]) -> None:
        """Add each taxel as a dot, from grey to red by its counts."""
        world, scene = self._world, self._scene
        turn = np.eye(3).ravel()
        for patch in world.layout.patches:
            body = mujoco.mj_name2id(world.model, mujoco.mjtObj.mjOBJ_BODY, patch.link)
            rotation = world.data.xmat[body].reshape(3, 3)
            points = patch.points_m().reshape(-1, 3) @ rotation.T + world.data.xpos[body]
            shares = np.clip(counts[patch.of(world.layout.taxels).ravel()] / 400.0, 0.0, 1.0)
            for point, share in zip(points, shares, strict=True):
                colour = np.array([0.25 + 0.75 * share, 0.30 * (1 - share), 0.35 * (1 - share), 1.0], dtype=np.float32)
                mujoco.mjv_initGeom(
                    scene.geoms[scene.ngeom],
                    mujoco.mjtGeom.mjGEOM_SPHERE,
                    np.full(3, _DOT_M * (1.0 + share)),
                    point,
                    turn,
                    colour,
                )
                scene.ngeom += 1
