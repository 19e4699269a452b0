SHARED_FILES += \
	shared/kernels/aov.cl \
	shared/kernels/bd_connect.cl \
	shared/kernels/bd_walk.cl \
	shared/kernels/caustic.cl \
	shared/kernels/count.cl \
	shared/kernels/film_add.cl \
	shared/kernels/ibpt.cl \
	shared/kernels/mlt.cl \
	shared/kernels/opening.cl \
	shared/kernels/photon.cl \
	shared/kernels/pt.cl \
	shared/kernels/rounding.cl \
	shared/kernels/trace.cl
