/* A session that C code recorded with integrations/broadmark_recorder.h. */
#pragma once

#ifdef __cplusplus
extern "C" {
#endif

/* Writes NAME.broadmark and NAME.csv: bodies in a row that overlap their neighbours, some of which
 * come and go, and change layers, in 12 frames. Returns 1 on success. */
int recordSession(const char* name);

#ifdef __cplusplus
}
#endif
