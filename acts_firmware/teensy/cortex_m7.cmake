# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

# Cross-compiling for the Teensy 4.1 with the compiler of the package gcc-arm-none-eabi and the flags of Teensyduino;
# of those the core and the sketch, not the tests, also do without exceptions and run-time types.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR cortex-m7)
set(CMAKE_CXX_COMPILER arm-none-eabi-g++)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
set(CMAKE_CXX_FLAGS_INIT "-mcpu=cortex-m7 -mthumb -mfpu=fpv5-d16 -mfloat-abi=hard")
string(APPEND CMAKE_CXX_FLAGS_INIT " -fno-threadsafe-statics -felide-constructors -ffunction-sections -fdata-sections")
set(CMAKE_CXX_FLAGS_RELEASE "-O2")
