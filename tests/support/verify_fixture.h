/* A scene opened on two backends to be compared word by word, and a backend with a fault. */
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

/* The first setup's scene, depth, seed and integrator on the backends of both. */
void verify_pair_open(const RenderSetup setups[2], VerifyPair *pair);
void verify_pair_close(VerifyPair *pair);

/* One bit of one word is wrong from the first step of its kind on. */
typedef struct Fault {
    StepKind kind;
    unsigned kernel; /* of STEP_KERNEL */
    BufferId buffer;
    uint field, item;
} Fault;

/* `of`, but what `inspect` hands over has the fault. One at a time. */
BackendInterface fault_backend(const BackendInterface *of, const Fault *fault);

#endif
