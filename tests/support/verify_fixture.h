/* A scene opened on two backends for word-by-word comparison, and a backend with a planted fault. */
#ifndef TWINLIGHT_TESTS_SUPPORT_VERIFY_FIXTURE_H
#define TWINLIGHT_TESTS_SUPPORT_VERIFY_FIXTURE_H

#include "render/verify.h"
#include "support/render_fixture.h"

typedef struct VerifyPair {
    Scene scene;
    BackendMember sides[2];
    StepList list;
    FrameParams frame;
} VerifyPair;

/* Opens the first setup's scene, with its depth, seed and integrator, on the backends of both. */
void verify_pair_open(const RenderSetup setups[2], VerifyPair *pair);
void verify_pair_close(VerifyPair *pair);

/* One bit of one word is wrong from the first step of that kind on. */
typedef struct Fault {
    StepKind kind;
    unsigned kernel; /* for STEP_KERNEL */
    BufferId buffer;
    uint field, item;
} Fault;

/* `of`, except that the result of `inspect` has the fault. Only one at a time. */
BackendInterface fault_backend(const BackendInterface *of, const Fault *fault);

/* `of`, except that `inspect` ignores STEP_SKIP_IF_IDLE, as a backend may. */
BackendInterface unskipping_backend(const BackendInterface *of);

#endif
