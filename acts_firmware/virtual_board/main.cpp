// Copyright 2026 ACTS contributors
// SPDX-License-Identifier: Apache-2.0

// The executable virtual_board: command line, signals, exit codes.
#include <sys/prctl.h>

#include <csignal>
#include <exception>
#include <iostream>
#include <memory>
#include <string>

#include "options.hpp"
#include "process.hpp"
#include "realtime.hpp"

namespace acts {

namespace {

volatile std::sig_atomic_t stop_requested = 0;

void request_stop(int signal) {
  if (stop_requested != SIGTERM) {
    stop_requested = signal;
  }
}

void install_signals() {
  struct sigaction action{};
  action.sa_handler = request_stop;  // without SA_RESTART: ends the sleep
  sigaction(SIGTERM, &action, nullptr);
  sigaction(SIGINT, &action, nullptr);
  struct sigaction hangup{};
  sigaction(SIGHUP, nullptr, &hangup);
  if (hangup.sa_handler != SIG_IGN) {  // nohup
    sigaction(SIGHUP, &action, nullptr);
  }
  action.sa_handler = SIG_IGN;
  sigaction(SIGPIPE, &action, nullptr);
}

}  // namespace

}  // namespace acts

int main(int argc, char** argv) {
  try {
    const acts::Options options = acts::parse_options(argc, argv);
    if (options.help) {
      std::cout << acts::help_text();
      return 0;
    }
    acts::install_signals();
    prctl(PR_SET_TIMERSLACK, 1000UL);  // wake within a microsecond or so of the time asked for, not fifty
    const auto process = std::make_unique<acts::Process>(options, acts::stop_requested);
    if (const std::string scheduling = acts::enter_realtime(options.realtime); !scheduling.empty()) {
      std::cerr << "virtual_board: " << scheduling << std::endl;
    }
    process->run();
    return 0;
  } catch (const acts::OptionError& error) {
    std::cerr << "virtual_board: " << error.what() << std::endl;
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "virtual_board: " << error.what() << std::endl;
    return 1;
  }
}
