# The readers of scenes, images, command lines, parts and checkpoints against arbitrary bytes. tests/fuzz_NAME is a test that
# runs the inputs of tests/corpus/NAME: seeds, and inputs that increased the fuzzers' coverage (fuzz-*: of 2e7 executions on
# scenes, 7e6 on images and 3e7 on command lines; 3e5 on parts found nothing, the two of checkpoints are findings
# of 2e5). `make fuzz` builds them with libFuzzer and sanitizers and runs each for FUZZ_SECONDS, starting from these.
EXTRA_DIST += tests/bad tests/corpus tests/fuzz/compile.sh tests/fuzz/fuzz.h tests/fuzz/run.sh tests/valgrind.supp
FUZZ_TARGETS = scene image options part checkpoint gltf
check_PROGRAMS += tests/fuzz_scene tests/fuzz_image tests/fuzz_options tests/fuzz_part tests/fuzz_checkpoint tests/fuzz_gltf
tests_fuzz_scene_SOURCES = tests/fuzz/fuzz_scene.c tests/fuzz/fuzz_replay.c
tests_fuzz_scene_CPPFLAGS = $(AM_CPPFLAGS) -DCORPUS='"corpus/scene bad"'
tests_fuzz_scene_LDADD = libtwinlight_host.la
tests_fuzz_image_SOURCES = tests/fuzz/fuzz_image.c tests/fuzz/fuzz_replay.c
tests_fuzz_image_CPPFLAGS = $(AM_CPPFLAGS) -DCORPUS='"corpus/image"'
tests_fuzz_image_LDADD = libtwinlight_host.la
tests_fuzz_options_SOURCES = tests/fuzz/fuzz_options.c tests/fuzz/fuzz_replay.c
tests_fuzz_options_CPPFLAGS = $(AM_CPPFLAGS) -DCORPUS='"corpus/options"'
tests_fuzz_options_LDADD = libtwinlight_host.la
tests_fuzz_part_SOURCES = tests/fuzz/fuzz_part.c tests/fuzz/fuzz_file.c tests/fuzz/fuzz_file.h tests/fuzz/fuzz_replay.c
tests_fuzz_part_CPPFLAGS = $(AM_CPPFLAGS) -DCORPUS='"corpus/part"'
tests_fuzz_part_LDADD = libtwinlight_host.la $(ZSTD_LIBS)
tests_fuzz_checkpoint_SOURCES = tests/fuzz/fuzz_checkpoint.c tests/fuzz/fuzz_file.c tests/fuzz/fuzz_replay.c
tests_fuzz_checkpoint_CPPFLAGS = $(AM_CPPFLAGS) -DCORPUS='"corpus/checkpoint"'
tests_fuzz_checkpoint_LDFLAGS = $(AM_LDFLAGS) $(FUZZ_WRAP)
tests_fuzz_checkpoint_LDADD = libtwinlight_cpu.la libtwinlight_host.la $(ZSTD_LIBS)
tests_fuzz_gltf_SOURCES = tests/fuzz/fuzz_gltf.c tests/fuzz/fuzz_file.c tests/fuzz/fuzz_replay.c
tests_fuzz_gltf_CPPFLAGS = $(AM_CPPFLAGS) -DCORPUS='"corpus/gltf"'
tests_fuzz_gltf_LDADD = libtwinlight_host.la $(ZSTD_LIBS)

# So that fuzz_checkpoint.c sees the fields that are read.
FUZZ_WRAP = -Wl,--wrap=archive_reader_open

# A larger image would take the time of thousands of others.
FUZZ_CC = clang
FUZZ_SECONDS = 60
FUZZ_JOBS = 2
FUZZ_SANITIZERS = fuzzer,address,undefined,float-cast-overflow
FUZZ_CFLAGS = -std=c11 -O1 -g -ffp-contract=off -fsanitize=$(FUZZ_SANITIZERS) -fno-sanitize-recover=undefined,float-cast-overflow \
	-DIMAGE_PIXELS_MAX=65536u
FUZZ_COMPILE = $(FUZZ_CC) $(FUZZ_CFLAGS) $(DEFS) -I. $(AM_CPPFLAGS) -pthread $(OPENEXR_CFLAGS) $(PNG_CFLAGS) \
	$(ZLIB_CFLAGS) $(STB_CFLAGS) $(MICROHTTPD_CFLAGS) $(MPI_CFLAGS) $(ASSIMP_CFLAGS)
.PHONY: fuzz fuzz-programs
fuzz-programs: build_commit.h
	$(MKDIR_P) fuzz-objects
	for file in $(libtwinlight_host_la_SOURCES) $(libtwinlight_cpu_la_SOURCES) $(libtwinlight_kernels_la_SOURCES) \
	  $(libtwinlight_wide_la_SOURCES) tests/fuzz/fuzz_file.c; do case $$file in *.c) echo $$file;; esac; done | \
	  xargs -P $(FUZZ_JOBS) -I{} $(srcdir)/tests/fuzz/compile.sh {} $(srcdir) "$(WIDE_CFLAGS)" $(FUZZ_COMPILE)
	for target in $(FUZZ_TARGETS); do case $$target in checkpoint) wrap=$(FUZZ_WRAP);; *) wrap=;; esac; \
	  $(FUZZ_COMPILE) $$wrap $(srcdir)/tests/fuzz/fuzz_$$target.c fuzz-objects/*.o -o fuzz_$$target \
	  $(libtwinlight_host_la_LIBADD) || exit 1; done

fuzz: fuzz-programs
	for target in $(FUZZ_TARGETS); do echo $$target; done | \
	  xargs -P $(FUZZ_JOBS) -I{} $(srcdir)/tests/fuzz/run.sh {} $(srcdir) $(FUZZ_SECONDS)
CLEANFILES += fuzz_scene fuzz_image fuzz_options fuzz_part fuzz_checkpoint fuzz_gltf

# The readers and small renderings on the CPU under valgrind, which detects what sanitizers do not: uninitialised
# values, and errors inside libraries. Takes half a minute.
VALGRIND = valgrind --quiet --error-exitcode=9 --leak-check=full --suppressions=$(srcdir)/tests/valgrind.supp
VALGRIND_TESTED = $(FUZZ_TARGETS:%=tests/fuzz_%$(EXEEXT)) tests/test_import$(EXEEXT) tests/test_texture$(EXEEXT) \
	twinlight$(EXEEXT)
.PHONY: check-valgrind
check-valgrind: $(VALGRIND_TESTED)
	for target in $(FUZZ_TARGETS); do srcdir=$(srcdir) $(VALGRIND) tests/fuzz_$$target >valgrind.log || exit 1; done
	for case in bad files limits params; do \
	  srcdir=$(srcdir) CK_FORK=no CK_RUN_CASE=$$case $(VALGRIND) tests/test_import || exit 1; done
	srcdir=$(srcdir) CK_FORK=no CK_RUN_CASE=files $(VALGRIND) tests/test_texture
	for integrator in pt ibpt bdpt mmlt; do \
	  $(VALGRIND) ./twinlight render --quiet --backend=cpu --threads=2 --integrator=$$integrator --resolution=12x8 \
	    --samples=2 --max-depth=5 --output=valgrind.exr $(srcdir)/scenes/showcase.pbrt || exit 1; done
CLEANFILES += valgrind.log valgrind.exr valgrind.png
