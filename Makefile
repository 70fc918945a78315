# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

# make demo and make test do all the set-up they need, in this checkout, and say what they do.
# `make PYTHON=/path/to/python3 ...` chooses the interpreter, `make ROS=jazzy ...` the distribution (default: kilted).

.PHONY: help setup demo demo-hand bench firmware test test-quick lint format clean

help:
	@echo "make demo    ball balancing with simulated skin, ball and UR5e (DEMO_SECONDS=30); writes out/"
	@echo "make demo-hand  the reflexes of a simulated LEAP hand, about a minute (HAND=slip: one act); writes out/"
	@echo "make bench   throughput, CPU and latency of the sensing end, about five minutes; writes out/bench.json"
	@echo "make firmware  cross-compile the Teensy's firmware, check that it fits; needs the packages"
	@echo "               gcc-arm-none-eabi libnewlib-arm-none-eabi libstdc++-arm-none-eabi-newlib"
	@echo "make test    linters and the whole test suite (ROS=jazzy: on ROS 2 Jazzy instead of Kilted)"
	@echo "make test-quick  ruff and the tests that take no time, for every day"
	@echo "make lint    linters and type checks only"
	@echo "make format  format Python and C++"
	@echo "make setup   only the set-up: virtual environment, ROS 2 wheels, colcon build"
	@echo "make clean   remove everything that was built or installed, and out/"

setup:
	@bash -c 'set -euo pipefail; source scripts/enter.sh; echo "[setup] ready: ./acts --help"'

demo:
	@./acts demo ball_balancing $(if $(DEMO_SECONDS),--seconds $(DEMO_SECONDS))

demo-hand:
	@./acts demo hand $(HAND)

bench:
	@./acts bench $(BENCH)

firmware:
	@./acts run python3 scripts/firmware.py

test:
	@./acts run python3 scripts/check.py

test-quick:
	@./acts run python3 scripts/check.py --quick

lint:
	@./acts run python3 scripts/check.py --lint

format:
	@./acts run python3 scripts/check.py --format

# What is running would go on without its files, and not come again after a crash; a set-up would take what it has
# installed so far for whole.
clean:
	@for lock in .acts/lock .acts/*/lock; do \
	if [ -f "$$lock" ] && ! flock -n "$$lock" true; then \
	echo "not cleaned: a set-up of this checkout is under way, wait for it" >&2; exit 1; fi; done
	@running=$$(grep -Fsl "$(CURDIR)/.acts/" /proc/[0-9]*/maps | tr -dc '0-9\n' | tr '\n' ' '); \
	if [ -n "$$running" ]; then echo "not cleaned: end what runs from here first (ps $$running)" >&2; exit 1; fi
	rm -rf .acts build install log out acts_*/build acts_*/*.egg-info .mypy_cache .ruff_cache .pytest_cache
