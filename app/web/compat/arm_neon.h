// Debian's emscripten lacks its own, which xxhash.h includes for WebAssembly: see XXH_VECTOR.
#pragma once
