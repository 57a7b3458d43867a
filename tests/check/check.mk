# Static checks; the Makefile compiles with warnings as errors. The tools that look for bugs and broken rules do not fail
# themselves: tests/check/deviations compares their reports with lib/DEVIATIONS.md.

.PHONY: check check-words check-lengths check-natives check-format check-shell check-lua check-scripts check-manual check-site check-rooms check-libm check-paths check-proofs check-builds check-deviations
C_FILES := $(shell find lib tests -name '*.[ch]')
CXX_FILES := $(shell find lib -name '*.[ch]pp')
FORMATTED := $(C_FILES) $(shell find lib tests -name '*.[ch]pp' -o -name '*.java')
SHELL_SCRIPTS := $(shell awk 'FNR == 1 && /^.!.*sh$$/ { print FILENAME }' .ci/run lib/build/* lib/spy/start $(filter-out $(patsubst %/.,%,$(wildcard tests/*/*/.)),$(wildcard tests/run tests/*/*)))

check: check-format check-words check-lengths check-natives check-shell check-lua check-scripts check-manual check-site check-rooms check-libm check-paths check-proofs check-builds check-deviations

check-format:
	@clang-format --dry-run --Werror $(FORMATTED)

# With pipefail, a pipe into `grep -q` or `head` fails now and then: the reader ends early and SIGPIPE ends the writer.
check-shell:
	@shellcheck -x $(SHELL_SCRIPTS)
	@! grep -nE '[^|]\| *(grep -[a-zA-Z]*q|head )' $(SHELL_SCRIPTS)

# It counts how sentences begin.
check-words:
	@! command -v python3 >/dev/null || tests/check/words

# It counts the words of manuals' chapters and of their tables' cells.
check-lengths:
	@! command -v python3 >/dev/null || tests/check/lengths

# The list of the functions that Lua may call is that of the C sources.
check-natives:
	@! command -v python3 >/dev/null || tests/check/natives

check-lua:
	@$(foreach file,$(LUA_SOURCES),luac5.4 -p $(file) &&) true

# This check is skipped by name if eslint is missing: only CI installs it, since it brings Node.
check-scripts:
	@tests/browser/lint || test $$? = 77

# groff reports errors, but does not fail.
check-manual: $(B)/waferhand.1
	@groff -man -Tutf8 -ww -z $< 2>&1 | awk '{ print } END { exit NR > 0 }'

# Each page of the manuals is on their site, and each link leads somewhere. Only CI installs what makes the site.
check-site:
	@if command -v sphinx-build >/dev/null; then lib/build/site $(B)/site; \
	else echo 'SKIPPED check-site: sphinx-build is missing: lib/build/need --install manual'; fi

check-rooms:
	@tests/check/rooms

check-libm:
	@tests/check/libm

check-paths:
	@tests/check/paths

# This weaves and parses; `make verify` proves.
check-proofs:
	@tests/check/proofs

# The matrix of compilers, flags and build systems takes about two minutes on two processors. If a tool is missing, its part is
# skipped by name.
check-builds:
	@tests/check/builds

# ---------------------------------------------------------------------------------- one log a source and tool
# clang-tidy looks at all of lib, with clang's own warnings; clang alone looks at the compiled files of tests. Analysis along
# all paths takes long. `make check` runs clang's, which ends early in a long function; `make verify` runs the whole of it, and
# gcc's (tests/verify/analysers).
SOURCES := $(LIBRARY_SOURCES) $(COLLISION_SOURCES) $(PROGRAM_SOURCES)
CHECKED_TESTS := $(filter %.c,$(TEST_SOURCES)) $(addsuffix .c,$(TOOLS) $(BENCHES)) tests/firmware/controller.c tests/firmware/edge_gripper.c $(wildcard tests/fuzz/*.c)
CHECKED_CXX_TESTS := $(filter %.cpp,$(TEST_SOURCES))
CXX_LOGS := $(PROGRAM_CXX_SOURCES:%.cpp=$(B)/tidy/%.log)
TEST_LOGS := $(CHECKED_TESTS:%.c=$(B)/clang/%.log)
CXX_TEST_LOGS := $(CHECKED_CXX_TESTS:%.cpp=$(B)/clang/%.log)
logs = $(foreach tool,$(1),$(SOURCES:%.c=$(B)/$(tool)/%.log))
SOURCE_LOGS := $(call logs,tidy scan) $(CXX_LOGS) $(TEST_LOGS) $(CXX_TEST_LOGS)
CXX_PATH_LOGS := $(PROGRAM_CXX_SOURCES:%.cpp=$(B)/paths/%.log)
PATH_LOGS := $(call logs,paths analyzer) $(CXX_PATH_LOGS)
TOOL_FOLDERS := tidy scan paths analyzer
$(foreach tool,$(TOOL_FOLDERS),$(LIBRARY_SOURCES:%.c=$(B)/$(tool)/%.log)): FLAGS = $(filter-out -Werror,$(LIBRARY_FLAGS))
$(foreach tool,$(TOOL_FOLDERS),$(COLLISION_SOURCES:%.c=$(B)/$(tool)/%.log)): FLAGS = $(filter-out -Werror,$(COLLISION_FLAGS))
$(foreach tool,$(TOOL_FOLDERS),$(PROGRAM_SOURCES:%.c=$(B)/$(tool)/%.log)): FLAGS = $(filter-out -Werror,$(PROGRAM_FLAGS))
$(CXX_LOGS) $(CXX_PATH_LOGS): FLAGS = $(filter-out -Werror,$(PROGRAM_CXX_FLAGS))
$(TEST_LOGS): FLAGS = $(filter-out -Werror,$(TEST_FLAGS))
$(CXX_TEST_LOGS): FLAGS = $(filter-out -Werror,$(CXX_TEST_FLAGS))
$(CXX_LOGS) $(CXX_PATH_LOGS): $(filter %.hpp,$(CXX_FILES))
$(TEST_LOGS) $(CXX_TEST_LOGS): $(wildcard tests/*/*.h)
$(SOURCE_LOGS) $(PATH_LOGS): $(HEADERS) $(B)/flags $(B)/lcm/waferhand_messages.h

comma := ,
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
$(B)/clang/%.log: %.c
	$(call look,CLANG,clang -fsyntax-only $(FLAGS) $<)
$(B)/clang/%.log: %.cpp
	$(call look,CLANG,clang++ -fsyntax-only $(FLAGS) $<)
# It visits a seventh of the places that it would visit by default, in a third of the time.
SCAN = clang --analyze --analyzer-output text
$(B)/scan/%.log: %.c
	$(call look,SCAN,$(SCAN) -Xclang -analyzer-config -Xclang max-nodes=30000 $(FLAGS) $<)
# All checks of clang except the ones that it calls experimental.
PATHS = $(SCAN) -Xclang -analyzer-checker=security$(comma)optin$(comma)valist$(comma)nullability
$(B)/paths/%.log: %.c
	$(call look,PATHS,$(PATHS) $(FLAGS) $<)
$(B)/paths/%.log: %.cpp
	$(call look,PATHS,$(PATHS) $(FLAGS) $<)
$(B)/analyzer/%.log: %.c
	$(call look,GCC ,LC_ALL=C gcc $(FLAGS) -O2 -fanalyzer -c -o /dev/null $<)

# ------------------------------------------------------------------------------------------- one log a tool
# Cppcheck needs only these facts from the system's headers. Without them it skips whole files, and says so only as an
# information.
CPPCHECK = cppcheck --quiet --std=c99 --library=posix,gnu --suppress=missingIncludeSystem -DFLT_EVAL_METHOD=0 -DLDBL_MANT_DIG=64 \
    --template='{file}:{line}:{column}: {severity}: {message} [{id}]'
CPPCHECK_PROGRAM = $(CPPCHECK) --enable=warning,performance,portability,information -D_GNU_SOURCE \
    -DLUA_VERSION_NUM=504 -DLUA_FLOAT_TYPE=2 -DLUA_FLOAT_DOUBLE=2 -DCCD_DOUBLE $(COLLISION_SOURCES) $(PROGRAM_SOURCES)
$(B)/log/program: $(COLLISION_SOURCES) $(PROGRAM_SOURCES) $(HEADERS) tests/check/check.mk
	$(call look,CPPCHECK,$(CPPCHECK_PROGRAM))

# The library in double; `make verify` checks the one with floats. The addon writes beside the sources unless there is a build
# folder. Such a folder keeps old results, so it is made anew.
CPPCHECK_LIBRARY = mkdir -p $@.d && $(CPPCHECK) --enable=style,information --addon=misra \
    --cppcheck-build-dir=$@.d -DWH_BUILDING_LIBRARY $(LIBRARY_SOURCES)
$(B)/log/library-float: CPPCHECK += -DWH_FLOAT
$(B)/log/library $(B)/log/library-float: $(LIBRARY_SOURCES) $(HEADERS) tests/check/check.mk
	@rm -rf $@.d
	$(call look,MISRA,$(CPPCHECK_LIBRARY))

# A function has at most 10 paths, each case of a switch counted, and at most 60 lines.
$(B)/log/functions: $(C_FILES) $(CXX_FILES) tests/check/functions.awk
	$(call look,PMCCABE,pmccabe $(C_FILES) $(CXX_FILES) 2>&1 | awk -F '\t' -f tests/check/functions.awk)
# Rooms whose lines, banners and members are checked.
TIDY_ROOMS := $(LIBRARY_ROOMS) $(COLLISION_ROOM) $(HOST_ROOMS)
$(B)/log/texts: $(C_FILES) $(CXX_FILES) tests/check/texts.awk tests/check/check.mk
	$(call look,TEXTS,LC_ALL=C awk -v embedded='^lib/($(subst $() ,|,$(LIBRARY_ROOMS)))/' \
	    -v tidy='^lib/($(subst $() ,|,$(TIDY_ROOMS)))/' -f tests/check/texts.awk $(C_FILES) $(CXX_FILES))

# The longest first.
LOGS := $(addprefix $(B)/log/,library program functions texts) $(SOURCE_LOGS)
# Rules that only the whole analysis along all paths reports, such as -Wanalyzer-... and core.NullDereference: their deviations
# may find nothing here.
check-deviations: $(LOGS) lib/DEVIATIONS.md
	@tests/check/deviations lib/DEVIATIONS.md elsewhere='^(-Wanalyzer-|[a-zA-Z]+[.])' $(LOGS)

# Lines and functions alone, in seconds, for while you work: `make -f lib/build/build.mk check-lines`.
.PHONY: check-lines
check-lines: $(B)/log/functions $(B)/log/texts
	@tests/check/deviations lib/DEVIATIONS.md elsewhere=. $^

# In `make verify` it is the other way round: these must find something, and the others need not.
.PHONY: analysers
analysers: $(B)/log/library-float $(PATH_LOGS)
	@tests/check/deviations lib/DEVIATIONS.md elsewhere='^[^-.]+(-|$$)' $^
