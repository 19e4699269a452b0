dist_man_MANS += \
	man/twinlight-render.1 \
	man/twinlight.1
