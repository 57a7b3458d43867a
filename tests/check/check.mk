# Static checks; compiling with warnings as errors is done by the Makefile. The tools that look for bugs and for broken
# rules do not fail: tests/check/deviations holds what they report against lib/DEVIATIONS.md.

.PHONY: check check-format check-shell check-lua check-scripts check-manual check-rooms check-paths check-proofs check-builds check-deviations
C_FILES := $(shell find lib tests -name '*.[ch]')
CXX_FILES := $(shell find lib -name '*.[ch]pp')
FORMATTED := $(C_FILES) $(shell find lib tests -name '*.[ch]pp' -o -name '*.java')
SHELL_SCRIPTS := $(shell awk 'FNR == 1 && /^.!.*sh$$/ { print FILENAME }' .ci/run lib/build/* lib/link/spy/start lib/view/fetch lib/view/start $(filter-out $(patsubst %/.,%,$(wildcard tests/*/*/.)),$(wildcard tests/run tests/*/*)))

check: check-format check-shell check-lua check-scripts check-manual check-rooms check-paths check-proofs check-builds check-deviations

check-format:
	@clang-format --dry-run --Werror $(FORMATTED)

# With pipefail a pipe into `grep -q` or `head` fails now and then: the reader ends early, the writer by SIGPIPE.
check-shell:
	@shellcheck -x $(SHELL_SCRIPTS)
	@! grep -nE '[^|]\| *(grep -[a-zA-Z]*q|head )' $(SHELL_SCRIPTS)

check-lua:
	@$(foreach file,$(LUA_SOURCES),luac5.4 -p $(file) &&) true

# Skipped by name where eslint is not: only CI installs it, for with it comes Node.
check-scripts:
	@tests/browser/lint || test $$? = 77

# groff reports, but does not fail.
check-manual: $(B)/waferhand.1
	@groff -man -Tutf8 -ww -z $< 2>&1 | awk '{ print } END { exit NR > 0 }'

check-rooms:
	@tests/check/rooms

check-paths:
	@tests/check/paths

# Weaves and parses; `make verify` proves.
check-proofs:
	@tests/check/proofs

# The matrix of compilers, flags and build systems: about two minutes on two processors. What a missing tool would have done is skipped by name.
check-builds:
	@tests/check/builds

# ---------------------------------------------------------------------------------- one log a source and tool
SOURCES := $(LIBRARY_SOURCES) $(COLLISION_SOURCES) $(PROGRAM_SOURCES)
CXX_LOGS := $(PROGRAM_CXX_SOURCES:%.cpp=$(B)/tidy/%.log)
SOURCE_LOGS := $(foreach tool,tidy scan analyzer,$(SOURCES:%.c=$(B)/$(tool)/%.log)) $(CXX_LOGS)
$(foreach tool,tidy scan analyzer,$(LIBRARY_SOURCES:%.c=$(B)/$(tool)/%.log)): FLAGS = $(filter-out -Werror,$(LIBRARY_FLAGS))
$(foreach tool,tidy scan analyzer,$(COLLISION_SOURCES:%.c=$(B)/$(tool)/%.log)): FLAGS = $(filter-out -Werror,$(COLLISION_FLAGS))
$(foreach tool,tidy scan analyzer,$(PROGRAM_SOURCES:%.c=$(B)/$(tool)/%.log)): FLAGS = $(filter-out -Werror,$(PROGRAM_FLAGS))
$(CXX_LOGS): FLAGS = $(filter-out -Werror,$(PROGRAM_CXX_FLAGS))
$(CXX_LOGS): $(filter %.hpp,$(CXX_FILES))
$(SOURCE_LOGS): $(HEADERS) $(B)/flags $(B)/lcm/waferhand_messages.h

# $(call look,WHAT,COMMAND): the command's log, shown when the command itself fails
define look
@mkdir -p $(@D)
@echo "  $(1) $@"
$(Q)$(2) >$@ 2>&1 || { cat $@; exit 1; }
endef
define tidy
$(call look,TIDY,clang-tidy --quiet $< -- $(FLAGS))
$(Q)sed -i 's|^$(CURDIR)/||' $@
endef
$(B)/tidy/%.log: %.c .clang-tidy
	$(tidy)
$(B)/tidy/%.log: %.cpp .clang-tidy
	$(tidy)
$(B)/scan/%.log: %.c
	$(call look,SCAN,clang --analyze --analyzer-output text $(FLAGS) $<)
$(B)/analyzer/%.log: %.c
	$(call look,GCC ,LC_ALL=C gcc $(FLAGS) -O2 -fanalyzer -c -o /dev/null $<)

# ------------------------------------------------------------------------------------------- one log a tool
# Of the system's headers cppcheck needs only these facts; without them it skips whole files, and says so as an
# information.
CPPCHECK = cppcheck --quiet --std=c99 --library=posix,gnu --suppress=missingIncludeSystem -DFLT_EVAL_METHOD=0 -DLDBL_MANT_DIG=64 \
    --template='{file}:{line}:{column}: {severity}: {message} [{id}]'
CPPCHECK_PROGRAM = $(CPPCHECK) --enable=warning,performance,portability,information -D_GNU_SOURCE \
    -DLUA_VERSION_NUM=504 -DLUA_FLOAT_TYPE=2 -DLUA_FLOAT_DOUBLE=2 -DCCD_DOUBLE $(COLLISION_SOURCES) $(PROGRAM_SOURCES)
$(B)/log/program: $(COLLISION_SOURCES) $(PROGRAM_SOURCES) $(HEADERS) tests/check/check.mk
	$(call look,CPPCHECK,$(CPPCHECK_PROGRAM))

# In double and in float. The addon writes beside the sources unless there is a build folder; that one remembers, so it is
# made anew.
CPPCHECK_LIBRARY = mkdir -p $@.d/$(1) && $(CPPCHECK) --enable=style,information --addon=misra \
    --cppcheck-build-dir=$@.d/$(1) -DWH_BUILDING_LIBRARY $(2) $(LIBRARY_SOURCES)
$(B)/log/library: $(LIBRARY_SOURCES) $(HEADERS) tests/check/check.mk
	@rm -rf $@.d
	$(call look,MISRA,{ $(call CPPCHECK_LIBRARY,double) && $(call CPPCHECK_LIBRARY,float,-DWH_FLOAT); })

# At most 10 ways through a function, each case of a switch counted, and 60 lines.
$(B)/log/functions: $(C_FILES) $(CXX_FILES) tests/check/functions.awk
	$(call look,PMCCABE,pmccabe $(C_FILES) $(CXX_FILES) 2>&1 | awk -F '\t' -f tests/check/functions.awk)
# Rooms whose lines, banners and members are looked at.
TIDY_ROOMS := $(LIBRARY_ROOMS) $(COLLISION_ROOM) $(HOST_ROOMS)
$(B)/log/texts: $(C_FILES) $(CXX_FILES) tests/check/texts.awk tests/check/check.mk
	$(call look,TEXTS,LC_ALL=C awk -v embedded='^lib/($(subst $() ,|,$(LIBRARY_ROOMS)))/' \
	    -v tidy='^lib/($(subst $() ,|,$(TIDY_ROOMS)))/' -f tests/check/texts.awk $(C_FILES) $(CXX_FILES))

LOGS := $(SOURCE_LOGS) $(addprefix $(B)/log/,library program functions texts)
check-deviations: $(LOGS) lib/DEVIATIONS.md
	@tests/check/deviations lib/DEVIATIONS.md $(LOGS)
