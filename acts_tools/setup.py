# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

from setuptools import find_packages, setup

PACKAGE = "acts_tools"

setup(
    name=PACKAGE,
    version="0.1.0",
    packages=find_packages(exclude=["test"]),
    package_data={PACKAGE: ["py.typed"]},
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{PACKAGE}"]),
        (f"share/{PACKAGE}", ["package.xml"]),
        # On PATH; what entry points make is for `ros2 run` and is not.
        ("bin", ["bin/acts"]),
    ],
    python_requires=">=3.10",
    install_requires=["setuptools"],
    extras_require={"test": ["pytest"]},
    zip_safe=False,
    description="The acts command: launch, view, record, export, selftest, train, evaluate, bench, demo and more.",
    license="Apache-2.0",
    entry_points={"console_scripts": ["acts = acts_tools.__main__:run"]},
)
