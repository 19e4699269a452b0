# `make bench`: benchmarks, as tables on standard output. Not part of `make check`. In this order:
#   bench_rays       rays/s of the CPU backend against bare Embree, one thread, generated meshes
#   bench_bvh        rays/s of Embree, and of the devices' hierarchy traversed in C and in OpenCL, on BENCH_SCENES
#   bench_render.sh  samples/s and rays/s of the CPU backend on BENCH_SCENES, scaling over threads, loading a big mesh
#   bench_opencl.sh  samples/s of a device with and without overlap, with its own film, and of the CPU; rays/s of both
#   bench_mmlt.sh    gains of sorting and grouping chains, acceptance rates by depth, on the CPU and the first device
#   bench_error.sh   variance against time of all integrators on BENCH_SCENES
# By hand, under Open MPI:
#   bench_mpi.sh     two ranks against one process, what they exchange, and a model of many nodes
# By hand, with a second program built with --enable-double:
#   bench_double.sh  differences between pictures of both
# By hand, with a compiler's cache in PATH, for an hour:
#   bench_ablation.sh  error without each constant and mechanism of MMLT that ablation.txt lists
# By hand, 80 minutes a scene:
#   bench_real.sh    as bench_error.sh, at the sizes of real pictures; MMLT against the best of the others
# Each explains its columns at its top. RUNS, SECONDS_EACH and DEPTH shorten the scripts, DEVICE selects a device.
BENCH_SCENES = $(srcdir)/scenes/cornell.pbrt $(srcdir)/scenes/showcase.pbrt

EXTRA_PROGRAMS += bench/make_ply
bench_make_ply_SOURCES = bench/make_ply.c
bench_make_ply_LDADD = -lm
EXTRA_PROGRAMS += bench/bench_rays
bench_bench_rays_SOURCES = bench/bench_rays.c
bench_bench_rays_LDADD = libtwinlight_cpu.la libtwinlight_host.la $(EMBREE_LIBS) -lm
EXTRA_PROGRAMS += bench/bench_bvh
bench_bench_bvh_SOURCES = bench/bench_bvh.c $(OPENCL_PROBE)
bench_bench_bvh_CPPFLAGS = $(AM_CPPFLAGS) -I$(srcdir)/tests
bench_bench_bvh_LDADD = libtwinlight_cpu.la libtwinlight_host.la $(EMBREE_LIBS) $(OPENCL_LIBS) -lm
EXTRA_PROGRAMS += bench/block_difference
bench_block_difference_SOURCES = bench/block_difference.c
bench_block_difference_LDADD = libtwinlight_host.la -lm
CLEANFILES += bench/block_difference$(EXEEXT) bench/bench_bvh$(EXEEXT) bench/make_ply$(EXEEXT) bench/bench_rays$(EXEEXT)
EXTRA_DIST += bench/ablation.txt bench/ablation_summary.awk bench/bench_ablation.sh bench/bench.sh bench/bench_util.h bench/bench_double.sh bench/bench_error.sh bench/bench_mmlt.sh bench/bench_mpi.sh bench/bench_opencl.sh bench/bench_real.sh bench/bench_render.sh

.PHONY: bench
bench: twinlight$(EXEEXT) bench/make_ply$(EXEEXT) bench/bench_rays$(EXEEXT) bench/bench_bvh$(EXEEXT)
	./bench/bench_rays$(EXEEXT)
	./bench/bench_bvh$(EXEEXT) $(srcdir)/shared $(BENCH_SCENES)
	$(srcdir)/bench/bench_render.sh ./twinlight$(EXEEXT) ./bench/make_ply$(EXEEXT) $(BENCH_SCENES)
if HAVE_OPENCL
	$(srcdir)/bench/bench_opencl.sh ./twinlight$(EXEEXT) $(BENCH_SCENES)
endif
	$(srcdir)/bench/bench_mmlt.sh ./twinlight$(EXEEXT) $(BENCH_SCENES)
	$(srcdir)/bench/bench_error.sh ./twinlight$(EXEEXT) $(BENCH_SCENES)
