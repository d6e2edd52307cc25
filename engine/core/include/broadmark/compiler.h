// The compiler of the including file, as text.
#pragma once

#if defined(__clang__)
#define BROADMARK_COMPILER "clang " __clang_version__
#else
#define BROADMARK_COMPILER "gcc " __VERSION__
#endif
