// Conversion of a case's result to and from JSON.
#pragma once

#include "broadmark/harness/case_result.h"
#include "broadmark/json_fields.h"

namespace broadmark {

Json caseToJson(const CaseResult&);
/// Throws InputError.
CaseResult caseFrom(const JsonFields&);

/// Adds the values for each repetition or frame.
void addFrames(Json& json, const CaseResult&);
/// Throws InputError.
void readFrames(const JsonFields&, CaseResult&);

}  // namespace broadmark
