// The compiler of the including file, as text: "gcc 13.2.0", "clang 19.1.7".
#pragma once

#if defined(__clang__)
#define BROADMARK_COMPILER "clang " __clang_version__
#else
#define BROADMARK_COMPILER "gcc " __VERSION__
#endif
