// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// What to do about what a node complains of: by words in its sentence, the first that fits.

const HAND = "Is the hand powered and its adapter plugged in, and may this user open its port? See docs/hand.md.";
const ROBOT = "Is the robot on, reachable and in remote control? See docs/ball_balancing.md.";
const ADVICE = [
  [/end all but one/i, "What is shown is a mixture of what these nodes say. A second skin needs a namespace of its own, and a recording is played without its drivers."],
  [/no board|no frames from|is closed|no such port|cannot open/i, "Is the board plugged in and powered? acts doctor tells which ports there are, and whether you may open them."],
  [/parameters rows and cols/i, "The array has another size than the parameters rows and cols say: give the launch file that of the array, or acts view --board its --size."],
  [/crc|malformed|damaged/i, "Bytes are damaged on the way: try another cable or port, without a hub; see docs/faults.md."],
  [/not in force/i, "The board does not answer: its firmware may be another one (parameter protocol), or the line only goes one way."],
  [/do not fit/i, "Driver and reconstruction must have the same rows and cols; what does not fit is in the log."],
  // Before what is lost of a stream: of these the machine is not to blame.
  [/connection\b.*\blost/i, ROBOT],
  [/lost its power/i, HAND],
  [/stopped writing its joints/i, "The simulated robot has ended: look where it was started, and start it again."],
  [/lost|overrun|\blate\b|cycles missed|stood still/i, "The machine is too busy, or the port too slow: acts doctor tells what it lacks; see docs/real_time.md."],
  [/no samples/i, "Does the driver of this skin run and have a board? Its own line says."],
  [/no contact messages|no touch/i, "Does the reconstruction of this skin run? Its own line says."],
  [/stopped|given up/i, "Motion has ended. Mend the reason that is told, then start it again."],
  [/\bhand\b|motor/i, HAND],
  [/robot|connect/i, ROBOT],
];
const STALE = "The node has ended or hangs: look where it was started, and start it again.";

/** In words; empty where nothing needs doing or nothing is known. */
export function advice(level, message) {
  if (level === "ok") return "";
  if (level === "stale") return STALE;
  // Without the names of topics and ports, which may hold any word: there is "late" in /plate.
  const words = message.replace(/(^|\s)\/\S+/g, "");
  return ADVICE.find(([pattern]) => pattern.test(words))?.[1] ?? "";
}
