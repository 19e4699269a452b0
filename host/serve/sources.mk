libtwinlight_host_la_SOURCES += \
	host/serve/connections.c host/serve/connections.h \
	host/serve/error_curve.c host/serve/error_curve.h \
	host/serve/pixels.c host/serve/pixels.h \
	host/serve/quiet_thread.c host/serve/quiet_thread.h \
	host/serve/request.c host/serve/request.h \
	host/serve/server.h \
	host/serve/snapshot.c host/serve/snapshot.h \
	host/serve/status.c host/serve/status.h \
	host/serve/status_json.c host/serve/status_json.h \
	host/serve/tev.c host/serve/tev.h \
	host/serve/tev_packet.c host/serve/tev_packet.h \
	host/serve/watch.c host/serve/watch.h

if HAVE_MICROHTTPD
libtwinlight_host_la_SOURCES += host/serve/server.c
else
libtwinlight_host_la_SOURCES += host/serve/server_absent.c
endif

# The page with its style and script, as the bytes of a C array.
SERVE_PAGE = host/serve/page.html host/serve/page.css host/serve/page.js
EXTRA_DIST += $(SERVE_PAGE)
host/serve/server.lo: serve_page.h
serve_page.h: $(SERVE_PAGE)
	@folder=$(srcdir)/host/serve; \
	  awk -v folder="$$folder" '/^@.*@$$/ { file = folder "/" substr($$0, 2, length($$0) - 2); \
	    while ((getline line < file) > 0) print line; next } { print }' $$folder/page.html | \
	  od -An -v -tx1 | sed 's/[0-9a-f][0-9a-f]/0x&,/g' >$@.new && mv $@.new $@
CLEANFILES += serve_page.h
