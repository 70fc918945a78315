# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The hand's world: motors move joints, joints move links, and links and object press each other through the skin.

It depends on no clock and no process: the same seed and the same commands to motors and world give the same bits.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from acts_core.errors import ActsError, SettingsError
from acts_core.settings import default_of, describe, setting, validate
from acts_core.skin import layout
from acts_sim.dynamixel import MODELS, Bus, Motor, OverloadLaw
from acts_sim.hand import model as hand_model
from acts_sim.hand.disturbances import Disturbances
from acts_sim.hand.holder import Holder
from acts_sim.hand.kinematics import LINKS, PALM
from acts_sim.hand.objects import OBJECTS, HeldObject, held_object, solids_of
from acts_sim.hand.skin import Skin, SkinConfig
from acts_sim.hand.tip import Tip
from acts_sim.hand.truth import COLUMN, PATCH_COLUMNS, PATCHES_FROM, HandTruth, row_width

STEP_S = 0.002
"""Length of a step [s]."""

# Of the physics in a step: foam that is pressed hard, or by a light object, is a stiff spring with much damping.
_SUBSTEPS = 4
_SMALLEST_KG = 0.01
# The cover rounds off 1 mm and the foam is 3 mm thick: what is smaller shows more than its weight, or falls through.
_SMALLEST_M, _LARGEST_M = 0.005, 0.045

_GRAVITY_M_S2 = 9.81

# Direction of gravity in the palm's frame.
_DOWN = {
    "palm_up": (0.0, 0.0, 1.0),
    "palm_down": (0.0, 0.0, -1.0),
    "thumb_up": (0.0, -1.0, 0.0),
    "thumb_down": (0.0, 1.0, 0.0),
    "fingers_up": (-1.0, 0.0, 0.0),
    "fingers_down": (1.0, 0.0, 0.0),
}

_UNSTABLE = (
    int(mujoco.mjtWarning.mjWARN_BADQPOS),
    int(mujoco.mjtWarning.mjWARN_BADQVEL),
    int(mujoco.mjtWarning.mjWARN_BADQACC),
)

_LOST_M = 0.15
"""An object that nothing holds and that is further than this from the middle of the grasp has fallen out [m]."""

_GRASP_MIDDLE_M = (-0.02, -0.037, -0.07)


@dataclass(frozen=True)
class HandWorldConfig(SkinConfig):
    """All settings of the hand's world."""

    layout: str = setting("leap_right", "name or file of the layout of the skin")
    pose: str = setting("palm_up", "orientation of the hand", choices=tuple(_DOWN))
    object: str = setting("sphere", "object in the hand", choices=("none", *OBJECTS))
    object_size_m: float = setting(
        0.0,
        "radius, or half the width of a box, 0.005 or more [m]; 0: default of the object",
        minimum=0.0,
        maximum=_LARGEST_M,
    )
    object_mass_kg: float = setting(0.0, "mass of the object, 0.01 or more [kg]; 0: default", minimum=0.0, maximum=2.0)
    object_x_m: float = setting(
        0.0, "start position of the object, from the palm's centre towards the fingers [m]", minimum=-0.1, maximum=0.1
    )
    object_y_m: float = setting(0.0, "start position towards the thumb's side [m]", minimum=-0.1, maximum=0.1)
    object_height_m: float = setting(0.0, "start position above the palm [m]", minimum=0.0, maximum=0.1)
    object_held: bool = setting(False, "whether the object is held there until the command let_go")
    motor_model: str = setting("xc330", "model of the motors", choices=tuple(sorted(MODELS)))
    return_delay_time: int = setting(250, "initial return delay time of the motors [2 us]", minimum=0, maximum=254)
    overload_after_s: float = setting(
        0.0, "a motor that has stalled for this long switches itself off [s]; 0: never", minimum=0.0, maximum=1000.0
    )
    overload_ma: float = setting(
        300.0, "a motor that stands still with at least this current is stalled [mA]", minimum=1.0, maximum=2000.0
    )
    seed: int = setting(
        1, "seed of the taxels' sensitivities and the object's unevenness", minimum=0, maximum=2**31 - 1
    )

    def __post_init__(self) -> None:
        validate(self)
        if 0.0 < self.object_mass_kg < _SMALLEST_KG:
            raise SettingsError(f"object_mass_kg = {self.object_mass_kg}: allowed is 0, or {_SMALLEST_KG} to 2 kg")
        if 0.0 < self.object_size_m < _SMALLEST_M:
            raise SettingsError(
                f"object_size_m = {self.object_size_m}: allowed is 0, or {_SMALLEST_M} to {_LARGEST_M} m"
            )
        for name in describe(HandWorldConfig):
            value = getattr(self, name)
            if self.object == "none" and name.startswith("object_") and value != default_of(HandWorldConfig, name):
                raise SettingsError(f"{name} = {value}: there is no object; choose one, or leave {name} out")
        if self.object != "none":
            thing = held_object(self.object, self.object_size_m, self.object_mass_kg)
            _require_in_reach(thing, self.object_x_m, self.object_y_m, self.object_height_m)


def _require_in_reach(thing: HeldObject, x_m: float, y_m: float, height_m: float) -> NDArray[np.float64]:
    """The place of an object above the palm, np.ndarray [shape=(3,)] [m]; refuse one where it would be lost at once."""
    where = thing.on_palm(x_m, y_m)
    where[2] -= height_m
    far_m = math.dist(where.tolist(), _GRASP_MIDDLE_M)
    if far_m > _LOST_M:
        raise SettingsError(
            f"an object at x = {1e3 * x_m:g} mm, y = {1e3 * y_m:g} mm, height = {1e3 * height_m:g} mm is "
            f"{1e3 * far_m:.0f} mm from the middle of the grasp; allowed is up to {1e3 * _LOST_M:g} mm, further away "
            "it counts as fallen out"
        )
    return where


class HandWorld:
    """Simulates the hand step by step.

    Parameters
    ----------
    config : HandWorldConfig

    Attributes
    ----------
    model, data : mujoco.MjModel, mujoco.MjData
        MuJoCo's model and state, for pictures.
    motors : list of Motor
        Sixteen motors, ordered by ID.
    bus : Bus
        Bus of these motors.
    blocked : set of int
        Indices of blocked joints.
    holder : Holder
        Springs that can hold the object besides the hand.
    tip : Tip
        The tip that can poke the skin.
    disturbances : Disturbances
        Further forces on object and hand.
    """

    def __init__(self, config: HandWorldConfig | None = None) -> None:
        self.config = config = config or HandWorldConfig()
        rng = np.random.default_rng(config.seed)
        self._thing: HeldObject | None = None
        if config.object != "none":
            self._thing = held_object(config.object, config.object_size_m, config.object_mass_kg)
        self.model = hand_model.build(self._thing, STEP_S / _SUBSTEPS)
        self.data = mujoco.MjData(self.model)
        self.layout = layout(config.layout, 32, 32)
        self._require_links()
        overload = OverloadLaw(config.overload_after_s, config.overload_ma)
        self.motors = [
            Motor(MODELS[config.motor_model], k, config.return_delay_time, overload=overload) for k in range(len(LINKS))
        ]
        self.bus: Bus = Bus(self.motors)
        self.blocked: set[int] = set()
        joints = [
            hand_model.joint_index(self.model, name)
            for _, name in sorted((link.motor_id, link.joint) for link in LINKS)
        ]
        self._q = np.array([self.model.jnt_qposadr[joint] for joint in joints])
        self._dof = np.array([self.model.jnt_dofadr[joint] for joint in joints])
        # The object's joint is the last one of the model.
        self._body = hand_model.body_index(self.model, hand_model.OBJECT)
        tip_body = hand_model.body_index(self.model, hand_model.TIP)
        solids = solids_of(self._thing, max(self._body, 0), tip_body, config.unevenness_m)
        self._skin = Skin(self.model, self.layout, solids, config, rng)
        self.tip = Tip(self.model, self.data, solids[-1], self.layout, config.cover_m)
        inertia_kg_m2 = float(self.model.body_inertia[self._body].min()) if self._thing else 0.0
        self.holder = Holder(self._thing.mass_kg if self._thing else 0.0, inertia_kg_m2)
        self.disturbances = Disturbances(self.weight_n, self.down)
        self.time_s = 0.0
        self._lost = False
        self._patch_index = {patch.name: k for k, patch in enumerate(self.layout.patches)}
        self._row = np.zeros(row_width(len(self.layout.patches)))
        self._row[COLUMN["object_quaternion"]] = 1.0, 0.0, 0.0, 0.0
        self.put(config.object_x_m, config.object_y_m, config.object_height_m, held=config.object_held)
        self._give_shafts()
        self._gravity = _GRAVITY_M_S2 * self.down
        self.model.opt.gravity[:] = self._gravity
        mujoco.mj_step1(self.model, self.data)
        # Compile the kernel now; otherwise that would delay the first step.
        self._skin.press(self.data, 0.0)

    @property
    def down(self) -> NDArray[np.float64]:
        """Direction of gravity in the palm's frame; np.ndarray [shape=(3,)], a unit vector."""
        return np.array(_DOWN[self.config.pose])

    @property
    def weight_n(self) -> float:
        """Weight of the object [N]; 0 without one."""
        return self._thing.mass_kg * _GRAVITY_M_S2 if self._thing else 0.0

    @property
    def counts(self) -> NDArray[np.float64]:
        """Counts of the skin before noise and rounding; np.ndarray [shape=(1024,)] in the order of the matrix."""
        return self._skin.counts()

    @property
    def forces_n(self) -> NDArray[np.float64]:
        """Force on every taxel [N]; np.ndarray [shape=(1024,)] in the order of the matrix, overwritten by `step`.

        Where the foam bottoms out, the links' rigid core carries the rest of the load: a small sphere that is pressed
        onto the palm with more than about 10 N, a sphere with more than about 30 N.
        """
        return self._skin.forces_n

    @property
    def has_object(self) -> bool:
        """Whether there is an object."""
        return self._thing is not None

    @property
    def is_lost(self) -> bool:
        """Whether the object has fallen out of the hand; it then stays where it is until `put`."""
        return self._lost

    def hold(self) -> None:
        """Hold the object at its present pose with springs."""
        if self._thing is not None:
            self.holder.hold(self.data.xpos[self._body], self.data.xquat[self._body])

    def _require_links(self) -> None:
        strange = [patch.link for patch in self.layout.patches if hand_model.body_index(self.model, patch.link) < 0]
        if strange:
            links = ", ".join([PALM, *(link.name for link in LINKS)])
            raise SettingsError(
                f"layout = {self.config.layout}: a patch lies on {strange[0] or 'no link'}, and "
                f"the simulated hand has the links {links}; allowed is leap_right or a file with patches on these"
            )

    def put(self, x_m: float, y_m: float, height_m: float = 0.0, *, held: bool = False) -> None:
        """Put the object on the palm, at an offset from its centre; held by springs, or free. Nothing pulls it then.

        Raises
        ------
        SettingsError
            For a place so far away that the object would count as fallen out.
        """
        if self._thing is None:
            return
        where = _require_in_reach(self._thing, x_m, y_m, height_m)
        self.data.qpos[-7:] = (*where, 1.0, 0.0, 0.0, 0.0)
        self.data.qvel[-6:] = 0.0
        self._lost = False
        self.disturbances.stop_pulling()
        if held:
            self.holder.hold(where, np.array([1.0, 0.0, 0.0, 0.0]))
        else:
            self.holder.drop()
        mujoco.mj_step1(self.model, self.data)

    def show(self, truth: HandTruth) -> None:
        """Set the poses of a truth, for a picture; motors and forces on the skin do not change."""
        data = self.data
        data.qpos[self._q] = truth.q_rad
        if self._thing is not None:
            start = self.model.jnt_qposadr[hand_model.joint_index(self.model, hand_model.OBJECT)]
            data.qpos[start : start + 7] = (*truth.object_position_m, *truth.object_quaternion)
        mujoco.mj_kinematics(self.model, data)

    def step(self) -> None:
        """Advance by `STEP_S`.

        Raises
        ------
        ActsError
            When the physics has become unstable.
        """
        data = self.data
        data.qfrc_applied[self._dof] = [motor.step(STEP_S) for motor in self.motors]
        for _ in range(_SUBSTEPS):
            self._substep(STEP_S / _SUBSTEPS)
        if any(data.warning[kind].number for kind in _UNSTABLE):
            raise ActsError(f"the hand's world is unstable after {self.time_s:.3f} s; the object may be too light")
        self._give_shafts()
        if self._body >= 0 and not self._lost and not self.holder.holding:
            self._lost = math.dist(data.qpos[-7:-4].tolist(), _GRASP_MIDDLE_M) > _LOST_M

    def _substep(self, dt_s: float) -> None:
        model, data = self.model, self.data
        self.time_s += dt_s
        # Also when nothing shakes: another shake may have ended this one in the middle of a swing.
        model.opt.gravity[:] = self._gravity
        if self.disturbances.is_shaking:
            model.opt.gravity[:] -= self.disturbances.shaking(dt_s)
        self.tip.advance(dt_s)
        mujoco.mj_step1(model, data)
        self.tip.measure()
        data.xfrc_applied[:] = 0.0
        self._skin.press(data, dt_s)
        if self._thing is not None:
            self._push_object(self._thing.mass_kg, dt_s)
        mujoco.mj_step2(model, data)
        if self.blocked:
            held = list(self.blocked)
            data.qvel[self._dof[held]] = 0.0
            data.qpos[self._q[held]] = [self.motors[k].shaft.position_rad - math.pi for k in held]

    def _push_object(self, mass_kg: float, dt_s: float) -> None:
        data, body = self.data, self._body
        wrench = data.xfrc_applied[body]
        wrench[:3] += self.disturbances.load(dt_s)
        if self.holder.holding:
            turn_rad_s = data.xmat[body].reshape(3, 3) @ data.qvel[-3:]
            wrench += self.holder.wrench(data.xpos[body], data.xquat[body], data.qvel[-6:-3], turn_rad_s, dt_s)
            wrench[:3] -= self.holder.strength * mass_kg * self.model.opt.gravity
        if self._lost:
            # It stays where it is, out of reach.
            data.qvel[-6:] = 0.0
            wrench[:3] = -mass_kg * self.model.opt.gravity
            wrench[3:] = 0.0

    def _give_shafts(self) -> None:
        angles = self.data.qpos[self._q].tolist()
        speeds = self.data.qvel[self._dof].tolist()
        for motor, angle, speed in zip(self.motors, angles, speeds, strict=True):
            motor.shaft.position_rad = math.pi + angle
            motor.shaft.velocity_rad_s = speed

    @property
    def truth(self) -> HandTruth:
        """The present true state."""
        return HandTruth.from_row(self.truth_row(), [patch.name for patch in self.layout.patches])

    def truth_row(self) -> NDArray[np.float64]:
        """The present true state as a row, see `acts_sim.hand.truth`; overwritten by the next call."""
        row, data, body = self._row, self.data, self._body
        row[COLUMN["time_s"]] = self.time_s
        if body >= 0:
            row[COLUMN["object_position_m"]] = data.qpos[-7:-4]
            row[COLUMN["object_velocity_m_s"]] = data.qvel[-6:-3]
            row[COLUMN["object_turn_rad_s"]] = data.xmat[body].reshape(3, 3) @ data.qvel[-3:]
            row[COLUMN["object_quaternion"]] = data.qpos[-4:]
        row[COLUMN["object_held"]] = self.holder.holding
        row[COLUMN["object_lost"]] = self._lost
        row[COLUMN["load_n"]] = self.disturbances.load_n
        row[COLUMN["gravity_m_s2"]] = self.model.opt.gravity
        row[COLUMN["tip_depth_m"]] = self.tip.depth_m
        row[COLUMN["tip_patch"]] = self._patch_index.get(self.tip.patch, -1)
        row[COLUMN["q_rad"]] = data.qpos[self._q]
        patches = row[PATCHES_FROM:].reshape(-1, len(PATCH_COLUMNS))
        patches[:] = self._skin.results
        patches[:, 1] /= np.maximum(patches[:, 0], 1e-12)
        return row
