#pragma once

/// ISOLUX_SANITIZED is defined where AddressSanitizer or ThreadSanitizer brings an allocator of its own, beside which
/// no program may have another. GCC and Clang say differently that they are there.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define ISOLUX_SANITIZED
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define ISOLUX_SANITIZED
#endif
#endif
