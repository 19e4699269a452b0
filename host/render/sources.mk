libtwinlight_host_la_SOURCES += \
	host/render/aov_image.c host/render/aov_image.h \
	host/render/bd_fields.c host/render/bd_fields.h \
	host/render/chain_statistics.c host/render/chain_statistics.h \
	host/render/checkpoint.c host/render/checkpoint.h \
	host/render/error_watch.c host/render/error_watch.h \
	host/render/film_pilot.c host/render/film_pilot.h \
	host/render/halves_error.c host/render/halves_error.h \
	host/render/identity.c host/render/identity.h \
	host/render/integrator.c host/render/integrator.h \
	host/render/integrator_bdpt.c \
	host/render/integrator_ibpt.c \
	host/render/integrator_pt.c \
	host/render/job.h \
	host/render/layers.c host/render/layers.h \
	host/render/merge.c host/render/merge.h \
	host/render/part.c host/render/part.h \
	host/render/opening_fit.c host/render/opening_fit.h \
	host/render/opening_frame.c host/render/opening_frame.h \
	host/render/opening_search.c host/render/opening_search.h \
	host/render/openings.c host/render/openings.h \
	host/render/photon_grid.c host/render/photon_grid.h \
	host/render/photon_lights.c host/render/photon_lights.h \
	host/render/photon_lobe.c host/render/photon_lobe.h \
	host/render/photon_map.c host/render/photon_map.h \
	host/render/photon_pass.c host/render/photon_pass.h \
	host/render/photon_paths.c host/render/photon_paths.h \
	host/render/photon_worth.c host/render/photon_worth.h \
	host/render/picture.c host/render/picture.h \
	host/render/pilot_file.c host/render/pilot_file.h \
	host/render/progress.c host/render/progress.h \
	host/render/render.c host/render/render.h \
	host/render/report.c host/render/report.h \
	host/render/run.c host/render/run.h \
	host/render/shard.c host/render/shard.h \
	host/render/stats.c host/render/stats.h \
	host/render/tile_light.c host/render/tile_light.h \
	host/render/verify.c host/render/verify.h
