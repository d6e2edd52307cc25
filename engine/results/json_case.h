// A case's result as JSON, and back.
#pragma once

#include "broadmark/harness/case_result.h"
#include "broadmark/json_fields.h"

namespace broadmark {

Json caseToJson(const CaseResult&);
/// Throws InputError.
CaseResult caseFrom(const JsonFields&);

/// The part with a value for each repetition or frame.
void addFrames(Json& json, const CaseResult&);
/// Throws InputError.
void readFrames(const JsonFields&, CaseResult&);

}  // namespace broadmark
