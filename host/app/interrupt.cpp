#include "app/interrupt.h"

#include <fmt/format.h>
#include <pthread.h>
#include <unistd.h>

#include "app/exit_codes.h"

namespace parhelion::app {

Interruption::Interruption() {
    sigemptyset(&signals_);
    for (const int signal : {SIGINT, SIGTERM}) {
        struct sigaction action {};
        sigaction(signal, nullptr, &action);
        if (action.sa_handler != SIG_IGN) sigaddset(&signals_, signal);
    }
    // With this one the destructor wakes the waiter.
    sigaddset(&signals_, SIGUSR1);
    pthread_sigmask(SIG_BLOCK, &signals_, &previous_);
    waiter_ = std::thread([this] { waitForSignals(); });
}

Interruption::~Interruption() {
    closing_ = true;
    pthread_kill(waiter_.native_handle(), SIGUSR1);
    waiter_.join();
    pthread_sigmask(SIG_SETMASK, &previous_, nullptr);
}

void Interruption::waitForSignals() {
    for (int signal = 0; sigwait(&signals_, &signal) == 0 && !closing_;) {
        if (signal == SIGUSR1) continue;
        if (deferred_ && !requested_.exchange(true)) {
            fmt::print(stderr,
                       "\nparhelion: stopping within two seconds or so, with the samples that all pixels have; "
                       "interrupt again to abort\n");
            continue;
        }
        const std::scoped_lock lock(outputs_);
        _exit(kExitInterrupted);
    }
}

}  // namespace parhelion::app
