// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

#include "semihosting.hpp"

#include <fcntl.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace {

enum class Request : std::uint32_t {
  kOpen = 0x01,
  kClose = 0x02,
  kWriteText = 0x04,
  kWrite = 0x05,
  kRead = 0x06,
  kCommandLine = 0x15,
  kExit = 0x20,
};

constexpr std::uint32_t kOpenToRead = 1;    // "rb"
constexpr std::uint32_t kOpenToWrite = 4;   // "w"; on ":tt" standard output
constexpr std::uint32_t kOpenToAppend = 8;  // "a"; on ":tt" standard error
constexpr std::uint32_t kApplicationExit = 0x20026;
constexpr std::size_t kMaxArguments = 8;

std::uint32_t ask(Request request, const void* block) {
  register std::uint32_t operation __asm__("r0") = static_cast<std::uint32_t>(request);
  register const void* argument __asm__("r1") = block;
  __asm__ volatile("bkpt 0xab" : "+r"(operation) : "r"(argument) : "memory");
  return operation;
}

std::uint32_t address_of(const void* pointer) {
  return reinterpret_cast<std::uintptr_t>(pointer);
}

std::uint32_t open_file(const char* name, std::uint32_t mode) {
  const std::uint32_t block[] = {address_of(name), mode, std::strlen(name)};
  return ask(Request::kOpen, block);
}

// File numbers 0 to 2 are the console's, others are the host's handles plus this.
constexpr int kFirstFile = 3;

std::uint32_t handle_of(int file) {
  static std::uint32_t consoles[kFirstFile] = {};
  if (file >= kFirstFile) {
    return static_cast<std::uint32_t>(file - kFirstFile);
  }
  std::uint32_t& console = consoles[file];
  if (console == 0) {
    constexpr std::uint32_t kModes[kFirstFile] = {kOpenToRead, kOpenToWrite, kOpenToAppend};
    console = open_file(":tt", kModes[file]) + 1;
  }
  return console - 1;
}

char text[512];
char* arguments[kMaxArguments];

}  // namespace

namespace acts {

Arguments command_line() {
  std::uint32_t block[] = {address_of(text), sizeof text};
  int count = 0;
  if (ask(Request::kCommandLine, block) == 0) {
    for (char* word = std::strtok(text, " "); word != nullptr && count < static_cast<int>(kMaxArguments);
         word = std::strtok(nullptr, " ")) {
      arguments[count++] = word;
    }
  }
  return {count, arguments};
}

void say_and_stop(const char* message) {
  ask(Request::kWriteText, message);
  const std::uint32_t block[] = {kApplicationExit, 1};
  for (;;) {
    ask(Request::kExit, block);
  }
}

}  // namespace acts

// What the C library calls.
extern "C" {

extern char heap_begin, heap_end;

int _open(const char* name, int flags, int /*mode*/) {
  if ((flags & O_ACCMODE) != O_RDONLY) {
    errno = EACCES;
    return -1;
  }
  const std::uint32_t handle = open_file(name, kOpenToRead);
  if (handle == UINT32_MAX) {
    errno = ENOENT;
    return -1;
  }
  return static_cast<int>(handle) + kFirstFile;
}

int _close(int file) {
  const std::uint32_t block[] = {handle_of(file)};
  return static_cast<int>(ask(Request::kClose, block));
}

// Both requests answer with the number of bytes that were left over.
int _read(int file, char* out, int length) {
  const std::uint32_t block[] = {handle_of(file), address_of(out), static_cast<std::uint32_t>(length)};
  return length - static_cast<int>(ask(Request::kRead, block));
}

int _write(int file, const char* data, int length) {
  const std::uint32_t block[] = {handle_of(file), address_of(data), static_cast<std::uint32_t>(length)};
  return length - static_cast<int>(ask(Request::kWrite, block));
}

int _lseek(int /*file*/, int /*offset*/, int /*whence*/) {
  errno = ESPIPE;
  return -1;
}

int _fstat(int /*file*/, struct stat* status) {
  status->st_mode = S_IFCHR;
  return 0;
}

int _isatty(int file) {
  return file < kFirstFile ? 1 : 0;
}

int _getpid() {
  return 1;
}

int _kill(int /*process*/, int /*signal*/) {
  acts::say_and_stop("aborted\n");
}

void* _sbrk(std::ptrdiff_t increment) {
  static char* top = &heap_begin;
  if (increment > &heap_end - top) {
    errno = ENOMEM;
    return reinterpret_cast<void*>(-1);
  }
  char* block = top;
  top += increment;
  return block;
}

[[noreturn]] void _exit(int code) {
  const std::uint32_t block[] = {kApplicationExit, static_cast<std::uint32_t>(code)};
  for (;;) {
    ask(Request::kExit, block);
  }
}

}  // extern "C"
