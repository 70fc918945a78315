// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// An array of 16 x 16 taxels on an Arduino Mega 2560: every frame a line of text, as docs/own_array.md explains.
//
// Wiring: row wires, the top one of the picture first, on pins 22 to 37. Column wires, the left one first, on channels
// 0 to 15 of a multiplexer (CD74HC4067), its address S0 to S3 on pins 4 to 7, its common pin on A0, and from A0 a
// resistor to ground: half of full scale is read where a taxel has the resistance of this one (1 kilohm to begin with).

const int ROWS = 16;
const int COLS = 16;
const int FIRST_ROW_PIN = 22;
const int FIRST_ADDRESS_PIN = 4;
const int ADDRESS_BITS = 4;
const unsigned long BAUD = 1000000;  // 16 x 16 values are up to 1300 bytes a frame: 7 frames/s at 115200 baud

int counts[ROWS][COLS];

void setup() {
  Serial.begin(BAUD);
  for (int row = 0; row < ROWS; row++) {
    pinMode(FIRST_ROW_PIN + row, OUTPUT);
    digitalWrite(FIRST_ROW_PIN + row, LOW);
  }
  for (int bit = 0; bit < ADDRESS_BITS; bit++) {
    pinMode(FIRST_ADDRESS_PIN + bit, OUTPUT);
  }
}

void loop() {
  const unsigned long begin_us = micros();
  for (int row = 0; row < ROWS; row++) {
    digitalWrite(FIRST_ROW_PIN + row, HIGH);
    for (int col = 0; col < COLS; col++) {
      for (int bit = 0; bit < ADDRESS_BITS; bit++) {
        digitalWrite(FIRST_ADDRESS_PIN + bit, (col >> bit) & 1);
      }
      counts[row][col] = analogRead(A0);  // 10 bits: 0 to 1023. Of an ADC with 12 bits: analogRead(A0) >> 2
    }
    digitalWrite(FIRST_ROW_PIN + row, LOW);
  }
  const unsigned long duration_us = micros() - begin_us;
  for (int row = 0; row < ROWS; row++) {
    for (int col = 0; col < COLS; col++) {
      Serial.print(counts[row][col]);
      Serial.print(',');
    }
  }
  Serial.println(duration_us);
}
