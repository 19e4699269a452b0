libtwinlight_host_la_SOURCES += \
	host/mmlt/bad_chains.c host/mmlt/bad_chains.h \
	host/mmlt/bidirectional_estimator.c host/mmlt/bidirectional_estimator.h \
	host/mmlt/chain_groups.c host/mmlt/chain_groups.h \
	host/mmlt/chain_list.c host/mmlt/chain_list.h \
	host/mmlt/chain_population.c host/mmlt/chain_population.h \
	host/mmlt/chain_seeds.c host/mmlt/chain_seeds.h \
	host/mmlt/chains_estimator.c host/mmlt/chains_estimator.h \
	host/mmlt/combination.c host/mmlt/combination.h \
	host/mmlt/combination_learn.c host/mmlt/combination_learn.h \
	host/mmlt/combination_rare.c host/mmlt/combination_rare.h \
	host/mmlt/combination_rates.c host/mmlt/combination_rates.h \
	host/mmlt/combination_stratified.c host/mmlt/combination_stratified.h \
	host/mmlt/combination_tile.c host/mmlt/combination_tile.h \
	host/mmlt/combination_variances.c host/mmlt/combination_variances.h \
	host/mmlt/combined_image.c host/mmlt/combined_image.h \
	host/mmlt/estimator.c host/mmlt/estimator.h \
	host/mmlt/generation.c host/mmlt/generation.h \
	host/mmlt/guide.c host/mmlt/guide.h \
	host/mmlt/importance.c host/mmlt/importance.h \
	host/mmlt/integrator_mmlt.c \
	host/mmlt/mmlt.c host/mmlt/mmlt.h \
	host/mmlt/mmlt_archive.c host/mmlt/mmlt_archive.h \
	host/mmlt/mmlt_init.c \
	host/mmlt/paths_estimator.c host/mmlt/paths_estimator.h \
	host/mmlt/plan.c host/mmlt/plan.h \
	host/mmlt/pool_estimator.c host/mmlt/pool_estimator.h \
	host/mmlt/scheme.c host/mmlt/scheme.h \
	host/mmlt/tuning.h
