# The scene reader against arbitrary bytes. tests/fuzz_scene replays files (with any compiler); `make fuzz` builds the
# reader with libFuzzer and sanitizers, and runs it for FUZZ_SECONDS from the seeds of tests/corpus.
EXTRA_DIST += tests/bad tests/corpus
EXTRA_PROGRAMS += tests/fuzz_scene
tests_fuzz_scene_SOURCES = tests/fuzz_scene.c
tests_fuzz_scene_CPPFLAGS = $(AM_CPPFLAGS) -DREPLAY
tests_fuzz_scene_LDADD = libtwinlight_host.la
CLEANFILES += tests/fuzz_scene$(EXEEXT) fuzz_scene

FUZZ_CC = clang
FUZZ_SECONDS = 60
FUZZ_CFLAGS = -std=c11 -O1 -g -ffp-contract=off -fsanitize=fuzzer,address,undefined -fno-sanitize-recover=undefined
.PHONY: fuzz
fuzz:
	sources=; for file in $(libtwinlight_host_la_SOURCES); do \
	  case $$file in *.c) sources="$$sources $(srcdir)/$$file";; esac; done; \
	$(FUZZ_CC) $(FUZZ_CFLAGS) $(DEFS) -I. $(AM_CPPFLAGS) -pthread $(OPENEXR_CFLAGS) $(PNG_CFLAGS) $(ZLIB_CFLAGS) \
	  $(STB_CFLAGS) $(srcdir)/tests/fuzz_scene.c $$sources -o fuzz_scene \
	  $(libtwinlight_host_la_LIBADD) -pthread
	$(MKDIR_P) fuzz-found
	./fuzz_scene -max_total_time=$(FUZZ_SECONDS) -timeout=10 -rss_limit_mb=2048 -max_len=65536 \
	  -dict=$(srcdir)/tests/corpus/scene.dict fuzz-found $(srcdir)/tests/corpus
