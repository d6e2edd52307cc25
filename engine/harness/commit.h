// The commit that this build is of: a source file that each build generates (cmake/Commit.cmake).
#pragma once

namespace broadmark::build {

extern const char* const commit;       ///< 40 digits; "" if unknown
extern const char* const commit_date;  ///< ISO 8601; "" if unknown
extern const bool dirty;               ///< its sources had other changes

}  // namespace broadmark::build
