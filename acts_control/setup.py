# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

from setuptools import find_packages, setup

PACKAGE = "acts_control"

setup(
    name=PACKAGE,
    version="0.1.0",
    packages=find_packages(exclude=["test"]),
    package_data={PACKAGE: ["py.typed", "hand/description/hands/*.yaml"]},
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{PACKAGE}"]),
        (f"share/{PACKAGE}", ["package.xml"]),
    ],
    python_requires=">=3.10",
    install_requires=["setuptools"],
    extras_require={"test": ["pytest"]},
    zip_safe=False,
    description="Control by touch: ball balancing on a UR5e, reflexes of a LEAP hand.",
    license="Apache-2.0",
    entry_points={
        "console_scripts": [
            "ball_balancing = acts_control.programs:ball_balancing",
            "ball_control = acts_control.programs:ball_control",
            "ball_state = acts_control.programs:ball_state",
            "ball_trajectory = acts_control.programs:ball_trajectory",
            "hand = acts_control.programs:hand",
            "hand_reflexes = acts_control.programs:hand_reflexes",
        ],
    },
)
