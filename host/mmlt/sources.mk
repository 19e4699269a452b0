libtwinlight_host_la_SOURCES += \
	host/mmlt/bad.c \
	host/mmlt/bad_chains.c host/mmlt/bad_chains.h \
	host/mmlt/combination.c host/mmlt/combination.h \
	host/mmlt/combination_learn.c host/mmlt/combination_learn.h \
	host/mmlt/chain_groups.c host/mmlt/chain_groups.h \
	host/mmlt/chain_list.c host/mmlt/chain_list.h \
	host/mmlt/chain_population.c host/mmlt/chain_population.h \
	host/mmlt/chain_seeds.c host/mmlt/chain_seeds.h \
	host/mmlt/generation.c \
	host/mmlt/importance.c host/mmlt/importance.h \
	host/mmlt/integrator_mmlt.c \
	host/mmlt/mmlt.h \
	host/mmlt/pool.c \
	host/mmlt/scheme.c host/mmlt/scheme.h \
	host/mmlt/tuning.h
