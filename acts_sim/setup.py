# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

from setuptools import find_packages, setup

PACKAGE = "acts_sim"

setup(
    name=PACKAGE,
    version="0.1.0",
    packages=find_packages(exclude=["test"]),
    package_data={PACKAGE: ["py.typed"]},
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{PACKAGE}"]),
        (f"share/{PACKAGE}", ["package.xml"]),
    ],
    python_requires=">=3.10",
    install_requires=["setuptools"],
    extras_require={"test": ["pytest"]},
    zip_safe=False,
    description="The simulated world: what presses a skin, a ball on a plate, a UR5e, a LEAP hand; by real protocols.",
    license="Apache-2.0",
    entry_points={
        "console_scripts": [
            "dynamixel_bus = acts_sim.programs:dynamixel_bus",
            "ball_world = acts_sim.programs:ball_world",
            "hand_world = acts_sim.programs:hand_world",
            "ur_controller = acts_sim.programs:ur_controller",
        ],
    },
)
