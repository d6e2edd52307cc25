// The commit that this build is of: a source file that each build generates (cmake/Commit.cmake).
#pragma once

namespace broadmark {

extern const char* const kCommit;      ///< 40 digits; "" if unknown
extern const char* const kCommitDate;  ///< ISO 8601; "" if unknown
extern const bool kDirty;              ///< its sources had other changes

}  // namespace broadmark
