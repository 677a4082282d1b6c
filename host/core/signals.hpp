// Signals that ask the program to end: SIGINT, SIGTERM, SIGHUP, and SIGXCPU where processor time runs out. One that was
// ignored when the program began (nohup, a script's background job) stays ignored.
#pragma once

namespace stokes {

// Starts a thread that takes these signals, and holds them back from all others and from the programs that a driver
// starts; so they come through while a driver hangs. To be called on the main thread, before it has company.
// Until the program says what it has to keep, a signal ends it as it would have by itself, after the driver's call
// that is under way, and without leaving temporary files.
void watch_signals();

// The signal that has come, or 0.
int caught_signal();

inline constexpr const char* interrupted_in_set_up = "stokes: interrupted before the first pass: nothing was written\n";

// What a signal would lose from now on.
enum class AtStake {
    nothing,  // the signal ends the program
    set_up,   // the main thread asks caught_signal() and ends; where it does not for some seconds, the watch ends it
    passes,   // the main thread asks caught_signal() and keeps what there is; a second SIGINT or SIGTERM ends it
};
void set_at_stake(AtStake at_stake);

}  // namespace stokes
