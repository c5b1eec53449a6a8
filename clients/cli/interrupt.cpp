#include "clients/cli/cli.hpp"

#include <pthread.h>
#include <unistd.h>

#include <csignal>
#include <thread>

namespace driftlab::cli {
namespace {

std::stop_source& interrupt_source() {
  static std::stop_source source;
  return source;
}

}  // namespace

void watch_interrupts() {
  static sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  (void)interrupt_source();
  std::thread([] {
    int signal = 0;
    sigwait(&signals, &signal);
    interrupt_source().request_stop();
    sigwait(&signals, &signal);
    _exit(static_cast<int>(Exit::Interrupted));
  }).detach();
}

std::stop_token interrupt_token() { return interrupt_source().get_token(); }

}  // namespace driftlab::cli
