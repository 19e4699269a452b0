dist_man_MANS += \
	man/twinlight-bench.1 \
	man/twinlight-compare.1 \
	man/twinlight-devices.1 \
	man/twinlight-pyramid.1 \
	man/twinlight-render.1 \
	man/twinlight-scene.5 \
	man/twinlight.1
