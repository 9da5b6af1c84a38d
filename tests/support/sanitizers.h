// Whether the tests run under a sanitizer, whose shadow memory takes terabytes of addresses and much real memory.
#pragma once

namespace dapple::testing_support {

#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define DAPPLE_IS_SANITIZED
#endif
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define DAPPLE_IS_SANITIZED
#endif

#if defined(DAPPLE_IS_SANITIZED)
constexpr bool kIsSanitized = true;
#else
constexpr bool kIsSanitized = false;
#endif

}  // namespace dapple::testing_support
