# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""Choosing a port: among boards in a list, and on real pseudo-terminals that come back under another name."""

from __future__ import annotations

import os
import re
from pathlib import Path

import pytest
from ament_index_python.packages import get_package_share_directory
from pty_board import PtyBoard, frame, wait_for
from serial.tools.list_ports_common import ListPortInfo

from acts_core.errors import PortError, SettingsError
from acts_core.wire import StreamDecoder
from acts_driver.port import Reader, SerialSource
from acts_driver.port.port_choice import TEENSY_SERIAL, Lister, resolve
from acts_driver.settings import DriverSettings


def usb_port(device: str, number: str | None, usb: tuple[int, int] = TEENSY_SERIAL) -> ListPortInfo:
    """A port as list_ports describes it."""
    port = ListPortInfo(device)
    port.description = "USB Serial"
    port.vid, port.pid = usb
    port.serial_number = number
    return port


def listing(*ports: ListPortInfo) -> Lister:
    return lambda: ports


LEFT = usb_port("/dev/ttyACM0", "111")
RIGHT = usb_port("/dev/ttyACM1", "222")
MODEM = usb_port("/dev/ttyACM2", "333", (0x1199, 0x9071))
UART = ListPortInfo("/dev/ttyS0")


def test_a_path_is_taken_as_it_is() -> None:
    def never() -> list[ListPortInfo]:
        raise AssertionError("a path needs no list")

    assert resolve("/tmp/run/board", never) == "/tmp/run/board"


def test_auto_takes_the_only_teensy() -> None:
    assert resolve("auto", listing(MODEM, UART, RIGHT)) == "/dev/ttyACM1"


def test_a_board_by_its_serial_number() -> None:
    assert resolve("serial:111", listing(RIGHT, LEFT)) == "/dev/ttyACM0"
    # Not only a Teensy: the number is what was asked for.
    assert resolve("serial:333", listing(RIGHT, LEFT, MODEM)) == "/dev/ttyACM2"


def test_several_boards_are_listed_and_none_is_taken() -> None:
    with pytest.raises(PortError) as caught:
        resolve("auto", listing(RIGHT, MODEM, LEFT))
    message = str(caught.value)
    for words in ("2 boards fit", "/dev/ttyACM0 (USB Serial, USB 16C0:0483, serial number 111)", "serial number 222"):
        assert words in message
    assert "name one of them as the port: serial:111, serial:222" in message
    assert "333" not in message


def test_boards_without_distinct_numbers_are_told_apart_by_path() -> None:
    twins = listing(usb_port("/dev/ttyACM0", "7"), usb_port("/dev/ttyACM1", "7"))
    with pytest.raises(PortError, match=r"as the port: /dev/ttyACM0, /dev/ttyACM1"):
        resolve("serial:7", twins)
    with pytest.raises(PortError, match=r"as the port: /dev/ttyACM0, /dev/ttyACM1"):
        resolve("auto", listing(usb_port("/dev/ttyACM0", None), usb_port("/dev/ttyACM1", None)))


@pytest.mark.parametrize("port", ["auto", "serial:999"])
def test_no_board_lists_what_is_there_instead(port: str) -> None:
    with pytest.raises(PortError) as caught:
        resolve(port, listing(UART, MODEM))
    message = str(caught.value)
    assert message.startswith(f"port {port}: no ")
    assert "Ports present: /dev/ttyACM2 (USB Serial, USB 1199:9071, serial number 333), /dev/ttyS0." in message
    with pytest.raises(PortError, match="No serial ports are present"):
        resolve(port, listing())


@pytest.mark.parametrize("port", ["", " ", "serial:"])
def test_words_that_are_no_port(port: str) -> None:
    with pytest.raises(SettingsError, match=r"port = .*serial:NUMBER"):
        DriverSettings(port=port)


def test_a_board_that_comes_back_under_another_name_is_found_again(tmp_path: Path) -> None:
    board = PtyBoard(tmp_path)

    def present() -> list[ListPortInfo]:
        # What udev would show: the terminal of this moment, without the link.
        return [usb_port(os.path.realpath(board.path), "42")] if board.path.is_symlink() else []

    sequences: list[int] = []
    source = SerialSource("serial:42", lister=present)
    reader = Reader(
        source,
        StreamDecoder(),
        lambda frames, _: sequences.extend(one.sequence for one in frames),
        reconnect_s=0.05,
    )
    reader.start()
    wait_for(lambda: "no board with USB serial number 42" in reader.problem, "the reason")
    with board:
        wait_for(lambda: reader.connected, "the board")
        first = os.path.realpath(board.path)
        assert source.name == f"serial:42 ({first})"
        board.write_frames(frame(1))
        wait_for(lambda: sequences == [1], "a frame")
        # The number of the first terminal stays taken, so that the board gets another one.
        kept = os.open(first, os.O_RDWR | os.O_NOCTTY)
        board.unplug()
        wait_for(lambda: not reader.connected, "the loss")
        board.plug_in()
        assert os.path.realpath(board.path) != first
        wait_for(lambda: reader.connected, "the recovery")
        board.write_frames(frame(2))
        wait_for(lambda: sequences == [1, 2], "a frame after it")
        reader.stop()
        os.close(kept)


def test_the_udev_rule_is_installed_and_early_enough() -> None:
    folder = Path(get_package_share_directory("acts_driver")) / "udev"
    (rule,) = folder.glob("*.rules")
    # 73-seat-late.rules acts on the tag uaccess.
    assert int(rule.name[:2]) < 73
    lines = [line for line in rule.read_text().splitlines() if line and not line.startswith("#")]
    for line in lines:
        assert re.fullmatch(r'(\w+(\{\w+\})?(==|\+=|=)"[^"]*"(, )?)+', line), line
    (port,) = [line for line in lines if line.startswith('SUBSYSTEM=="tty"')]
    for word in ('"16c0"', '"0483"', 'TAG+="uaccess"', 'ID_MM_PORT_IGNORE}="1"', 'SYMLINK+="acts/$attr{serial}"'):
        assert word in port
