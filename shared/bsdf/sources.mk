SHARED_FILES += \
	shared/bsdf/bsdf.h \
	shared/bsdf/bsdf_state.h \
	shared/bsdf/coat.h \
	shared/bsdf/coated.h \
	shared/bsdf/coated_conductor.h \
	shared/bsdf/conductor.h \
	shared/bsdf/dielectric.h \
	shared/bsdf/diffuse.h \
	shared/bsdf/diffuse_transmission.h \
	shared/bsdf/fibre.h \
	shared/bsdf/fresnel.h \
	shared/bsdf/hair.h \
	shared/bsdf/lobe.h \
	shared/bsdf/material.h \
	shared/bsdf/microfacet.h \
	shared/bsdf/phase.h \
	shared/bsdf/thin_dielectric.h
