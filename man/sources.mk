dist_man_MANS += \
	man/twinlight-bench.1 \
	man/twinlight-compare.1 \
	man/twinlight-convert.1 \
	man/twinlight-devices.1 \
	man/twinlight-info.1 \
	man/twinlight-merge.1 \
	man/twinlight-pyramid.1 \
	man/twinlight-render.1 \
	man/twinlight-scene.5 \
	man/twinlight.1

bashcompletiondir = $(datadir)/bash-completion/completions
dist_bashcompletion_DATA = man/bash/twinlight
zshcompletiondir = $(datadir)/zsh/site-functions
dist_zshcompletion_DATA = man/zsh/_twinlight

# The pages name the folder of the scenes as it is by default.
install-data-hook:
	for page in $(dist_man_MANS); do \
	  case $$page in *.1) folder=$(man1dir) ;; *) folder=$(man5dir) ;; esac; \
	  installed="$(DESTDIR)$$folder/$${page##*/}"; \
	  sed 's|/usr/local/share/twinlight/scenes|$(scenesdir)|g' "$$installed" >"$$installed.new" && \
	    cat "$$installed.new" >"$$installed" && rm "$$installed.new" || exit 1; \
	done
