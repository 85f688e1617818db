#pragma once

#include "byte_source.h"
#include "sent_volume.h"

#include <isolux/core/run.h>

#include <chrono>
#include <functional>
#include <string>

namespace isolux::detail {

/// Runs `work` in a child process (fork) and `take` here on the bytes that work sends: a crash or a hang of a library
/// that work calls ends the child, not the program. Safe while other threads run, as long as work needs no lock that
/// another part of the program may hold: glibc makes malloc, stdio and the loader usable in the child, and the library
/// called must not have been used outside such children. What work loads (dlopen) is gone with the child.
///
/// `what` names the file in messages. \throw IoError if the child crashed, was too slow, or ended early; InvalidInput
/// or IoError as `work` threw them; Cancelled when run.stop is triggered; whatever take throws. The child is gone on
/// return.
void run_in_child(const std::string& what, std::chrono::seconds time_limit, const Run& run,
                  const std::function<void(const SendBytes& send)>& work,
                  const std::function<void(ByteSource& received)>& take);

}  // namespace isolux::detail
