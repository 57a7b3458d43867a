# Static checks; compiling with warnings as errors and with gcc's analyzer is done by the Makefile.

.PHONY: check check-format check-shell check-lua check-manual check-cppcheck
FORMATTED := $(shell find lib tests -name '*.[ch]' -o -name '*.cpp' -o -name '*.java')
SHELL_SCRIPTS := $(shell awk 'FNR == 1 && /^.!.*sh$$/ { print FILENAME }' .ci/run lib/packaging/* lib/link/spy/start $(wildcard tests/run tests/*/*))
TIDY := $(LIBRARY_SOURCES:%.c=$(B)/tidy/%) $(PROGRAM_SOURCES:%.c=$(B)/tidy/%)

check: check-format check-shell check-lua check-manual check-cppcheck $(TIDY)

check-format:
	@clang-format --dry-run --Werror $(FORMATTED)

check-shell:
	@shellcheck -x $(SHELL_SCRIPTS)

check-lua:
	@$(foreach file,$(LUA_SOURCES),luac5.4 -p $(file) &&) true

# groff reports, but does not fail.
check-manual: $(B)/waferhand.1
	@groff -man -Tutf8 -ww -z $< 2>&1 | awk '{ print } END { exit NR > 0 }'

check-cppcheck:
	@echo "  CPPCHECK"
	@mkdir -p $(B)/cppcheck
	$(Q)cppcheck --quiet --std=c99 --library=posix,gnu --enable=warning,performance,portability --inline-suppr \
	    --suppress=missingIncludeSystem --error-exitcode=1 --cppcheck-build-dir=$(B)/cppcheck -Ilib \
	    $(LIBRARY_SOURCES) $(PROGRAM_SOURCES)

$(LIBRARY_SOURCES:%.c=$(B)/tidy/%): FLAGS = $(LIBRARY_FLAGS)
$(PROGRAM_SOURCES:%.c=$(B)/tidy/%): FLAGS = $(PROGRAM_FLAGS)
$(PROGRAM_SOURCES:%.c=$(B)/tidy/%): $(B)/lcm/waferhand_messages.h
$(B)/tidy/%: %.c $(HEADERS) .clang-tidy $(B)/flags
	@mkdir -p $(@D)
	@echo "  TIDY $<"
	$(Q)clang-tidy --quiet $< -- $(FLAGS) 2>$@.log || { cat $@.log; exit 1; }
	@touch $@
