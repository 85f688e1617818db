#pragma once

namespace isolux {

/// Has the C library give large arrays back to the system when they are freed (glibc; nothing elsewhere). By itself it
/// does so only up to the size of the largest one freed so far, up to 32 MB, and keeps what is smaller: stages that
/// each take and free tens of megabytes then hold much of it all together. Before anything is allocated.
void return_large_arrays();

}  // namespace isolux
