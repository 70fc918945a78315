# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

from setuptools import find_packages, setup

PACKAGE = "acts_driver"

setup(
    name=PACKAGE,
    version="0.1.0",
    packages=find_packages(exclude=["test"]),
    package_data={PACKAGE: ["py.typed"]},
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{PACKAGE}"]),
        (f"share/{PACKAGE}", ["package.xml"]),
        (f"share/{PACKAGE}/udev", ["udev/60-acts-teensy.rules"]),
    ],
    python_requires=">=3.10",
    install_requires=["acts_core", "numpy", "pyserial"],
    extras_require={"test": ["pytest"]},
    zip_safe=False,
    description="Serial driver of the ACTS tactile array: board bytes in, TactileSamples out.",
    license="Apache-2.0",
    entry_points={"console_scripts": [f"driver = {PACKAGE}.programs:driver"]},
)
