# `make bench`: speed of the program on BENCH_SCENES, one table on standard output. Not part of `make check`.
BENCH_SCENES = $(srcdir)/scenes/cornell.pbrt $(srcdir)/scenes/showcase.pbrt

EXTRA_PROGRAMS += bench/make_ply
bench_make_ply_SOURCES = bench/make_ply.c
bench_make_ply_LDADD = -lm
EXTRA_PROGRAMS += bench/bench_rays
bench_bench_rays_SOURCES = bench/bench_rays.c
bench_bench_rays_LDADD = libtwinlight_cpu.la libtwinlight_host.la $(EMBREE_LIBS) -lm
CLEANFILES += bench/make_ply$(EXEEXT) bench/bench_rays$(EXEEXT)
EXTRA_DIST += bench/bench_render.sh

.PHONY: bench
bench: twinlight$(EXEEXT) bench/make_ply$(EXEEXT) bench/bench_rays$(EXEEXT)
	./bench/bench_rays$(EXEEXT)
	$(srcdir)/bench/bench_render.sh ./twinlight$(EXEEXT) ./bench/make_ply$(EXEEXT) $(BENCH_SCENES)
