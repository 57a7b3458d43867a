# The rules for all that is built below B. The Makefile calls this file once everything it needs is installed.

B := build
include lib/build/switches.mk
# Flags that somebody gives are taken as they are. Ours differ from part to part.
GIVEN := $(filter-out undefined,$(origin CFLAGS))
CFLAGS ?= -O2 -g
# Debuggers get line numbers only: the full information about Eigen's templates is many times larger than the code.
CXXFLAGS ?= -O2 -g1
# Debuggers get line numbers only for code outside the library, and tests are optimised less: a build takes a quarter of the
# time.
PROGRAM_CFLAGS := $(if $(GIVEN),$(CFLAGS),-O2 -g1)
TEST_CFLAGS := $(if $(GIVEN),$(CFLAGS),-O1 -g1)
MESSAGE_CFLAGS := $(if $(GIVEN),$(CFLAGS),-O1)
# Its loops are short and many, and take a twentieth of a run's time.
COLLISION_CFLAGS := $(if $(GIVEN),$(CFLAGS),-O3 -g)
PKG_CONFIG ?= pkg-config
CCACHE ?= $(shell command -v ccache)
PREFIX ?= /usr/local
LIBDIR ?= $(PREFIX)/lib
JAVASCRIPT ?= /usr/share/javascript
WERROR ?= $(if $(CI),1)
Q := $(if $(V),,@)
# If none is given, take the cross compiler's own: arm-none-eabi-gcc-ar beside arm-none-eabi-gcc.
ifeq ($(origin AR),default)
AR := $(patsubst %gcc,%gcc-ar,$(firstword $(filter %-gcc,$(CC))))
AR := $(or $(AR),ar)
endif

# The library's options; lib/math/config.h reads them.
defined = $(shell sed -n 's/^.define $(1) //p' lib/math/config.h)
VERSION := $(call defined,WH_VERSION_MAJOR).$(call defined,WH_VERSION_MINOR).$(call defined,WH_VERSION_PATCH)

# ---------------------------------------------------------------------------------------------- sources
include tests/tests.mk
LIBRARY_SOURCES := $(wildcard $(LIBRARY_ROOMS:%=lib/%/*.c))
COLLISION_SOURCES := $(wildcard lib/$(COLLISION_ROOM)/*.c)
MODULE_SOURCES := $(wildcard lib/script/wh_module*.c)
# This is loaded by itself, under mpirun.
RANKS_SOURCE := lib/study/ranks_mpi.c
PROGRAM_SOURCES := $(filter-out $(RANKS_SOURCE),$(wildcard $(HOST_ROOMS:%=lib/%/*.c) lib/app/prompt/*.c))
PROGRAM_CXX_SOURCES := $(wildcard $(HOST_ROOMS:%=lib/%/*.cpp))
MESSAGES := $(patsubst lcm_types/%.lcm,%,$(wildcard lcm_types/*.lcm))
LUA_SOURCES := $(sort $(shell find lua -name '*.lua' 2>/dev/null))
EMBEDDED_LUA := $(patsubst lua/%,$(B)/precompiled/%,$(filter lua/mcs/% lua/dialects/control.lua,$(LUA_SOURCES)))
PAGE_SOURCES := $(sort $(wildcard lib/report/page/*))
HEADERS := $(wildcard lib/*.h lib/*/*.h lib/*/*/*.h lib/*/*.def)

LIBRARY_OBJECTS := $(LIBRARY_SOURCES:%.c=$(B)/obj/%.o)
COLLISION_OBJECTS := $(COLLISION_SOURCES:%.c=$(B)/obj/%.o)
TEST_OBJECTS := $(TESTS:%=$(B)/obj/%.o) $(TOOLS:%=$(B)/obj/%.o)
PROGRAM_CXX_OBJECTS := $(PROGRAM_CXX_SOURCES:%.cpp=$(B)/obj/%.o)
PROGRAM_OBJECTS := $(PROGRAM_SOURCES:%.c=$(B)/obj/%.o) $(PROGRAM_CXX_OBJECTS) $(B)/obj/embedded_lua.o $(B)/obj/embedded_page.o
MESSAGE_SOURCES := $(MESSAGES:%=$(B)/lcm/waferhand_%.c)
MESSAGE_OBJECTS := $(MESSAGE_SOURCES:$(B)/%.c=$(B)/obj/%.o)
MODULE_OBJECTS := $(MODULE_SOURCES:%.c=$(B)/pic/%.o)
MODULE_SUPPORT := $(LIBRARY_SOURCES:%.c=$(B)/pic/%.o)
COLLISION_SUPPORT := $(COLLISION_SOURCES:%.c=$(B)/pic/%.o)

# ------------------------------------------------------------------------------------------------ flags
# Any C compiler builds the library. Flags that only gcc and clang know go to these two; flags that only newer versions know go
# to those.
GNU := $(findstring __GNUC__,$(shell $(CC) -dM -E -x c /dev/null 2>/dev/null))
accepts = $(shell $(CC) $(1) -E -x c /dev/null >/dev/null 2>&1 && echo $(1))
WARNINGS := -Wall -Wextra -Wpedantic -Wshadow -Wundef -Wcast-align -Wcast-qual -Wformat=2 -Wvla -Wswitch-enum \
            -Wwrite-strings -Wsign-conversion
C_WARNINGS := -Wstrict-prototypes -Wmissing-prototypes
# A float build's tests do without this flag: they compare in double on purpose.
NUMBER_WARNINGS := -Wconversion -Wdouble-promotion

# A fused multiply-add would change bits from machine to machine, so -ffp-contract is off. gcc 12's vectoriser of straight code
# fuses a*b + c*d beside e*f - g*h even then. errno keeps sqrt from being one instruction. Users of the library compile with
# these flags as well.
SAME_BITS := -ffp-contract=off -fno-tree-slp-vectorize -fno-math-errno -DWH_NO_CONTRACTION
$(if $(filter-out sweep index,$(WITHOUT)),$(error WITHOUT=: of "sweep" and "index", not "$(WITHOUT)"))
SETTINGS := $(strip $(if $(FLOAT),-DWH_FLOAT) $(addprefix -DWH_WITHOUT_,$(shell echo '$(WITHOUT)' | tr a-z A-Z)))
# Users of the library have to define these as well: the number type and what is left out. FLOAT and WITHOUT say so, or CFLAGS,
# or the header that WH_CONFIG_FILE names.
DEFINES := $(if $(GNU),$(shell $(CC) $(CPPFLAGS) $(CFLAGS) $(EXTRA) $(SETTINGS) -ffreestanding -dM -E lib/math/config.h 2>/dev/null | \
    sed -nE 's/^.define (WH_FLOAT|WH_WITHOUT_SWEEP|WH_WITHOUT_INDEX|WH_MOST_AXES|WH_MOST_GRIPPERS)\b ?(.*)$$/-D\1=\2/p' | sed 's/=1$$//' | sort),$(SETTINGS))
ABI := $(call defined,WH_ABI)$(if $(filter -DWH_FLOAT%,$(DEFINES)),f)
# The prefix map keeps the folder's name out of the built files.
BASE := $(SAME_BITS) $(call accepts,-ffile-prefix-map=$(CURDIR)=.) $(WARNINGS) \
        $(if $(WERROR),-Werror) $(SETTINGS)
LIBRARY_FLAGS := $(if $(GNU),-std=c99 $(BASE) $(C_WARNINGS) $(NUMBER_WARNINGS),$(SETTINGS)) -DWH_BUILDING_LIBRARY
COLLISION_FLAGS = $(LIBRARY_FLAGS) $(call package_flags,ccd)
# A row of a table of fields that is no scalar ends with what a scalar has: all of it zero.
HOST_FLAGS := -std=c99 -D_GNU_SOURCE $(BASE) $(C_WARNINGS) -Wno-missing-field-initializers

# Code from lcm-gen is not clean under our warnings. We do not warn about its headers or those of other packages either.
MESSAGE_FLAGS := -std=c99 -D_GNU_SOURCE -ffile-prefix-map=$(CURDIR)=.
LCM_FLAGS := -isystem $(B)/lcm
package_flags = $(patsubst -I%,-isystem %,$(shell $(PKG_CONFIG) --cflags $(1) 2>/dev/null))
LUA := $(firstword $(foreach name,lua5.4 lua-5.4 lua54 lua,$(shell $(PKG_CONFIG) --exists $(name) 2>/dev/null && echo $(name))))
# liburdfdom's pkg-config file may name /usr/include itself; this folder has to stay behind C++'s own folders.
URDF_FLAGS := $(patsubst -I%,-idirafter %,$(shell $(PKG_CONFIG) --cflags urdfdom tinyxml qhull_r 2>/dev/null))
PROGRAM_FLAGS := $(HOST_FLAGS) $(NUMBER_WARNINGS) $(LCM_FLAGS) $(call package_flags,$(LUA) jansson libedit zlib libzstd) $(URDF_FLAGS)
# Eigen without its heap, which no matrix of ours needs. Code that throws or asks for C++'s own library is left out, so C can
# link it.
PROGRAM_CXX_FLAGS := -std=c++17 -fno-exceptions -fno-rtti $(BASE) $(NUMBER_WARNINGS) -DEIGEN_NO_MALLOC -DEIGEN_MPL2_ONLY $(call package_flags,eigen3)
TEST_FLAGS := $(HOST_FLAGS) $(if $(FLOAT),,$(NUMBER_WARNINGS)) -Ilib -Itests $(LCM_FLAGS) $(call package_flags,$(LUA) jansson)
CXX_TEST_FLAGS := -std=c++17 $(BASE) -Ilib -Itests $(call package_flags,eigen3)

# Lua comes from its static archive, so that its `^` calls the program's own pow and not that of libm.
LUA_ARCHIVE = $(firstword $(filter /%,$(foreach name,liblua5.4.a liblua-5.4.a liblua.a,\
                $(shell $(CC) -print-file-name=$(name)))))
# Open MPI, if it is installed.
MPI := $(firstword $(foreach name,ompi-c ompi,$(shell $(PKG_CONFIG) --exists $(name) 2>/dev/null && echo $(name))))
RANKS := $(if $(MPI),$(B)/waferhand_mpi.so)

# libmicrohttpd, likewise: without it --page says that it is missing. The program loads it by this name when a page is served.
PAGE := $(shell $(PKG_CONFIG) --exists libmicrohttpd 2>/dev/null && \
          readelf -d "$$($(CC) -print-file-name=libmicrohttpd.so)" 2>/dev/null | sed -n 's/.*soname: \[\(.*\)\].*/\1/p')

# liburdfdom is C++; the program links it with the C compiler all the same.
URDF_LIBS = -Wl,--as-needed $(shell $(PKG_CONFIG) --libs urdfdom tinyxml qhull_r) -lstdc++ -Wl,--no-as-needed
# LCM's pkg-config file asks for GLib's headers, which LCM's own do not need: hence -llcm. It stands before libwaferhand.a,
# which it uses.
COLLISION_LIBS = $(B)/libwaferhand_collision.a -Wl,--as-needed $(shell $(PKG_CONFIG) --libs-only-l ccd) -Wl,--no-as-needed
PROGRAM_LIBS = $(B)/libwaferhand_lcm.a $(LUA_ARCHIVE) $(shell $(PKG_CONFIG) --libs jansson libedit zlib libzstd) $(URDF_LIBS) -llcm -ldl -lpthread -lm

# This file is written only when its text changes. Whatever depends on it is rebuilt when a flag or the set of files changes.
STAMP := $(CC) $(CXX) $(CFLAGS) $(CXXFLAGS) $(LDFLAGS) $(EXTRA) $(CPPFLAGS) $(COLLISION_FLAGS) $(PROGRAM_FLAGS) $(TEST_FLAGS) \
         $(CXX_TEST_FLAGS) $(PROGRAM_CXX_FLAGS) $(MESSAGE_FLAGS) $(JAVASCRIPT)
$(B)/flags: TEXT = $(STAMP)
$(B)/page: TEXT = $(PAGE)
$(B)/sources: TEXT = $(LIBRARY_SOURCES) $(COLLISION_SOURCES) $(PROGRAM_SOURCES) $(PROGRAM_CXX_SOURCES) $(LUA_SOURCES) $(PAGE_SOURCES)
$(B)/messages: TEXT = $(MESSAGES)
$(B)/flags $(B)/sources $(B)/messages $(B)/page: FORCE
	@mkdir -p $(@D)
	@printf '%s\n' '$(TEXT)' | cmp -s - $@ || printf '%s\n' '$(TEXT)' >$@

# ---------------------------------------------------------------------------------------------- targets
.PHONY: all library shared collision shared-collision program ranks spy tests unit-tests sanitized-tests library-tests library-test-names install uninstall FORCE
.DELETE_ON_ERROR:
.SECONDARY:

all: library collision $(B)/waferhand $(B)/wh.so $(B)/waferhand.1 ranks
library: $(B)/libwaferhand.a
shared: $(B)/libwaferhand.so.$(ABI)
shared-collision: $(B)/libwaferhand_collision.so.$(ABI)
collision: $(B)/libwaferhand_collision.a
program: $(B)/waferhand
ranks: $(RANKS)
tests: unit-tests $(TOOLS:%=$(B)/%) $(BENCHES:%=$(B)/%)
unit-tests: $(TESTS:%=$(B)/%)
	@:
sanitized-tests: $(SANITIZED_TESTS:%=$(B)/%)
	@:
library-tests: $(LIBRARY_TESTS:%=$(B)/%)
	@:
library-test-names:
	@echo $(LIBRARY_TESTS)

# ------------------------------------------------------------------------------------------- compiling
$(LIBRARY_OBJECTS): FLAGS = $(LIBRARY_FLAGS)
$(COLLISION_OBJECTS): FLAGS = $(COLLISION_FLAGS)
$(COLLISION_OBJECTS) $(COLLISION_SUPPORT): CFLAGS := $(COLLISION_CFLAGS)
$(PROGRAM_OBJECTS): CFLAGS := $(PROGRAM_CFLAGS)
$(MESSAGE_OBJECTS): CFLAGS := $(MESSAGE_CFLAGS)
$(TEST_OBJECTS) $(B)/obj/tests/program_tests.o $(B)/obj/tests/library_tests.o: CFLAGS := $(TEST_CFLAGS)
$(PROGRAM_OBJECTS): FLAGS = $(PROGRAM_FLAGS)
$(PROGRAM_CXX_OBJECTS): FLAGS = $(PROGRAM_CXX_FLAGS)
$(LIBRARY_SOURCES:%.c=$(B)/pic/%.o): FLAGS = $(LIBRARY_FLAGS) -fPIC -fvisibility=hidden
$(COLLISION_SUPPORT): FLAGS = $(COLLISION_FLAGS) -fPIC -fvisibility=hidden
$(MODULE_OBJECTS): FLAGS = $(PROGRAM_FLAGS) -fPIC
$(B)/obj/lib/report/page.o: FLAGS += -DWH_JAVASCRIPT='"$(JAVASCRIPT)"'
PAGE_OBJECTS := $(B)/obj/lib/view/http.o $(B)/obj/lib/view/microhttpd.o
$(PAGE_OBJECTS): FLAGS += $(if $(PAGE),-DWH_MICROHTTPD='"$(PAGE)"' $(call package_flags,libmicrohttpd))
$(PAGE_OBJECTS): $(B)/page
# liburdfdom's headers throw.
$(B)/obj/lib/bodies/urdf_file.o: FLAGS += -fexceptions -frtti $(URDF_FLAGS)
# Only Eigen's decompositions: under sanitizers they are twenty times the code.
$(B)/obj/lib/estimate/rows.o: override EXTRA := $(filter-out -fsanitize% -fno-sanitize%,$(EXTRA))
# The compiler must not replace its pow by the pow that it knows.
$(B)/obj/lib/script/pow.o: FLAGS += -fno-builtin-pow
$(B)/obj/tests/%.o: FLAGS = $(TEST_FLAGS)
main_of = $(subst /,_,$(patsubst tests/%,%,$(1)))_main
$(foreach test,$(PROGRAM_TOGETHER) $(LIBRARY_TOGETHER),$(eval $(B)/obj/$(test).o: FLAGS += -DWH_TEST_MAIN=$(call main_of,$(test))))
$(CXX_TESTS:%=$(B)/obj/%.o): FLAGS = $(CXX_TEST_FLAGS)

# With CCACHE_DEPEND, ccache knows the headers of a file from its .d file alone. -MMD leaves system headers out, and the messages'
# generated ones count among them: an object of other messages would be taken for a right one.
DEPENDENCIES = $(if $(GNU),$(if $(CCACHE_DEPEND),-MD,-MMD) -MP)
define compile
@mkdir -p $(@D)
@echo "  $(1)  $<"
$(Q)$(CCACHE) $(2) $(FLAGS) $(CPPFLAGS) $(3) $(EXTRA) $(DEPENDENCIES) -c -o $@ $<
endef
$(if $(GNU),,$(LIBRARY_OBJECTS): $(HEADERS))
$(B)/obj/%.o: %.c $(B)/flags
	$(call compile,CC ,$(CC),$(CFLAGS))
$(B)/pic/%.o: %.c $(B)/flags
	$(call compile,PIC,$(CC),$(CFLAGS))
$(B)/obj/%.o: %.cpp $(B)/flags
	$(call compile,CXX,$(CXX),$(CXXFLAGS))
$(B)/obj/embedded_lua.o $(B)/obj/embedded_page.o: FLAGS = $(PROGRAM_FLAGS) -I.
$(B)/obj/embedded_lua.o $(B)/obj/embedded_page.o: $(B)/obj/%.o: $(B)/%.c $(B)/flags
	$(call compile,CC ,$(CC),$(CFLAGS))
# Motion control's files are compiled once, here.
$(B)/precompile: lib/build/precompile.c $(B)/flags
	@mkdir -p $(@D)
	$(Q)$(CC) $(PROGRAM_FLAGS) $(CFLAGS) $(EXTRA) -o $@ $< $(LUA_ARCHIVE) $(LDFLAGS) -ldl -lm
$(B)/precompiled/%.lua: lua/%.lua $(B)/precompile
	@mkdir -p $(@D)
	$(Q)$(B)/precompile $< >$@
$(B)/embedded_lua.c: lib/build/embed $(EMBEDDED_LUA) $(B)/sources
	@lib/build/embed wh_embedded $(B)/precompiled/ $(EMBEDDED_LUA) >$@
$(B)/embedded_page.c: lib/build/embed $(PAGE_SOURCES) $(B)/sources
	@lib/build/embed wh_embedded_page lib/report/page/ $(PAGE_SOURCES) >$@

# All messages are generated at once and anew, so that no file of a removed message stays. waferhand_messages.h includes the
# others and lists them: WAFERHAND_MESSAGES(X) is X(cell) X(command) and so on.
$(B)/lcm/waferhand_messages.h: $(MESSAGES:%=lcm_types/%.lcm) $(B)/messages
	@echo "  LCM  $(@D)"
	@rm -rf $(@D) && mkdir -p $(@D)
	$(Q)lcm-gen -c --c-cpath $(@D) --c-hpath $(@D) $(filter %.lcm,$^)
	@{ printf '#include <waferhand_%s.h>\n' $(MESSAGES); \
	    echo '#define WAFERHAND_MESSAGES(X) $(foreach message,$(MESSAGES),X($(message)))'; } >$@
$(MESSAGE_SOURCES): $(B)/lcm/waferhand_messages.h ;
$(B)/obj/lcm/%.o: $(B)/lcm/%.c $(B)/flags
	$(call compile,CC ,$(CC),$(CFLAGS))
$(MESSAGE_OBJECTS): FLAGS = $(MESSAGE_FLAGS)
# Compilers leave headers found by -isystem out of the .d files.
$(filter $(foreach room,wire link log host loop view study report print play app,$(B)/obj/lib/$(room)/%),$(PROGRAM_OBJECTS)) $(PROGRAM_TESTS:%=$(B)/obj/%.o) $(TOOLS:%=$(B)/obj/%.o): \
    $(B)/lcm/waferhand_messages.h

-include $(shell find $(B)/obj $(B)/pic -name '*.d' 2>/dev/null)

# --------------------------------------------------------------------------------------------- linking
# The archive is made anew with q: with r, the second of two members with the same base name would replace the first.
define archive
@echo "  AR   $@"
$(Q)rm -f $@ && { $(AR) qcsD $@ $(filter %.o,$^) 2>/dev/null || $(AR) qcs $@ $(filter %.o,$^); }
endef
$(B)/libwaferhand.a: $(LIBRARY_OBJECTS) $(B)/sources
	$(archive)
$(B)/libwaferhand_collision.a: $(COLLISION_OBJECTS) $(B)/sources
	$(archive)
$(B)/libwaferhand_lcm.a: $(MESSAGE_OBJECTS) $(B)/messages
	$(archive)
# The interface for callers that are not C: sizes and offsets as JSON, and a symbol for each inline function. Nothing runs, so a
# cross compiler does.
INTERFACE_FLAGS = $(filter-out -DWH_BUILDING_LIBRARY,$(LIBRARY_FLAGS)) -w $(CPPFLAGS) $(CFLAGS) $(EXTRA) $(if $(GNU),-fno-lto)
INTERFACE = $(CC) $(INTERFACE_FLAGS) $(ALSO:%=-DWH_INTERFACE_COLLISION) -Ilib -E lib/build/interface.c | awk -v version=$(VERSION) \
    -v real=$(if $(filter -DWH_FLOAT%,$(DEFINES)),float,double) $(ALSO:%=-v also=%) -f lib/build/interface.awk
INTERFACES := $(B)/interface.json $(B)/interface_collision.json
INLINE_FUNCTIONS := $(B)/inline_functions.c $(B)/inline_functions_collision.c
# Collision's is the whole of both: its structs have the library's. Its shared library has symbols of its own headers alone.
$(filter %_collision.json,$(INTERFACES)) $(filter %_collision.c,$(INLINE_FUNCTIONS)): ALSO := waferhand_collision.h
$(INTERFACES): $(B)/%.json: lib/build/interface.awk lib/build/interface.c $(HEADERS) $(B)/flags
	@mkdir -p $(@D)
	@echo "  JSON $@"
	$(Q)$(INTERFACE) -v make=json >$(B)/$*.c
	$(Q)$(CC) $(INTERFACE_FLAGS) -Ilib -c -o $(B)/$*.o $(B)/$*.c
	$(Q)LC_ALL=C sed -n '/^@begin$$/,/^@end$$/ { /^@/d; s/: \( *\)\(-*\) *\([0-9]\)/: \2\3/g; p }' $(B)/$*.o >$@ && test -s $@
$(INLINE_FUNCTIONS): lib/build/interface.awk lib/build/interface.c $(HEADERS) $(B)/flags
	@mkdir -p $(@D)
	$(Q)$(INTERFACE) $(if $(ALSO),-v room=$(COLLISION_ROOM)) -v make=inline >$@ && grep -q wh_symbol_of_ $@
$(INLINE_FUNCTIONS:$(B)/%.c=$(B)/pic/%.o): $(B)/pic/%.o: $(B)/%.c
	@mkdir -p $(@D)
	@echo "  PIC  $<"
	$(Q)$(CCACHE) $(CC) $(LIBRARY_FLAGS) -fPIC -fvisibility=hidden -Ilib $(CPPFLAGS) $(CFLAGS) $(EXTRA) -c -o $@ $<

# The library exports what its public headers declare, inline functions too, and nothing else. Its name for the loader contains the ABI, and the
# number type if that is float.
$(B)/libwaferhand.so.$(ABI): $(MODULE_SUPPORT) $(B)/pic/inline_functions.o $(B)/sources
	@echo "  LD   $@"
	$(LINK) -shared -Wl,-soname,libwaferhand.so.$(ABI),-z,defs,--as-needed -o $@ $(MODULE_SUPPORT) $(B)/pic/inline_functions.o -lm
	@ln -sf $(@F) $(@D)/libwaferhand.so
# It uses the library's own shared one, so a program has each function once.
$(B)/libwaferhand_collision.so.$(ABI): $(COLLISION_SUPPORT) $(B)/pic/inline_functions_collision.o $(B)/libwaferhand.so.$(ABI) $(B)/sources
	@echo "  LD   $@"
	$(LINK) -shared -Wl,-soname,libwaferhand_collision.so.$(ABI),-z,defs,--as-needed -o $@ $(COLLISION_SUPPORT) $(B)/pic/inline_functions_collision.o \
	    $(B)/libwaferhand.so.$(ABI) $(shell $(PKG_CONFIG) --libs-only-L --libs-only-l ccd) -lm
	@ln -sf $(@F) $(@D)/libwaferhand_collision.so
$(B)/pic/support.a: $(MODULE_SUPPORT) $(B)/sources
	$(archive)

LINK = $(Q)$(CC) $(CFLAGS) $(EXTRA) $(LDFLAGS)

# -E: native modules that a trusted script loads look for Lua's symbols in the program.
$(B)/waferhand: $(PROGRAM_OBJECTS) $(B)/libwaferhand.a $(B)/libwaferhand_collision.a $(B)/libwaferhand_lcm.a $(B)/sources
	@echo "  LD   $@"
	$(LINK) -Wl,-E -o $@ $(PROGRAM_OBJECTS) $(COLLISION_LIBS) $(B)/libwaferhand.a $(PROGRAM_LIBS)

# MPI code is kept apart, so that the program does not depend on MPI. It is built if MPI is installed, and loaded only under
# mpirun.
$(RANKS_SOURCE:%.c=$(B)/pic/%.o): FLAGS = $(HOST_FLAGS) -fPIC $(NUMBER_WARNINGS) $(call package_flags,$(MPI))
$(B)/waferhand_mpi.so: $(RANKS_SOURCE:%.c=$(B)/pic/%.o)
	@echo "  LD   $@"
	$(LINK) -shared -o $@ $< $(shell $(PKG_CONFIG) --libs $(MPI))

# The interpreter that loads the module provides Lua's symbols. With -z now a missing one shows at once. The module exports only
# its own symbols.
$(B)/wh.so: $(MODULE_OBJECTS) $(B)/pic/support.a
	@echo "  LD   $@"
	$(LINK) -shared -Wl,-z,now,--exclude-libs,ALL,--as-needed -o $@ $^ -lm

PROGRAM_ALONE := $(filter-out $(PROGRAM_TOGETHER),$(PROGRAM_TESTS)) $(TOOLS)
$(PROGRAM_ALONE:%=$(B)/%): $(filter-out $(B)/obj/lib/app/main.o,$(PROGRAM_OBJECTS)) $(B)/libwaferhand_lcm.a
$(PROGRAM_ALONE:%=$(B)/%): LIBS = $(PROGRAM_LIBS)
COLLISION_USERS := $(foreach user,$(PROGRAM_ALONE) $(filter-out $(LIBRARY_TOGETHER) $(PROGRAM_TOGETHER),$(COLLISION_TESTS)) $(BENCHES),$(B)/$(user))
$(COLLISION_USERS): $(B)/libwaferhand_collision.a
$(COLLISION_USERS): COLLISION = $(COLLISION_LIBS)
# The example firmware stands beside its tests.
$(filter $(B)/tests/firmware/%,$(TESTS:%=$(B)/%)): $(B)/obj/tests/firmware/controller.o $(B)/obj/tests/firmware/edge_gripper.o
$(B)/tests/property/chain_random: LIBS = $(shell pkg-config --libs orocos-kdl)
$(CXX_TESTS:%=$(B)/%): LINK = $(Q)$(CXX) $(CXXFLAGS) $(EXTRA) $(LDFLAGS)
$(B)/tests/%: $(B)/obj/tests/%.o $(B)/libwaferhand.a
	@mkdir -p $(@D)
	@echo "  LD   $@"
	$(LINK) -o $@ $(filter %.o,$^) $(COLLISION) $(B)/libwaferhand.a $(LIBS) -lcmocka -lm

# One program holds many tests, and is linked under the names of all of them.
define list_tests
@mkdir -p $(@D)
@printf '#define WH_TESTS(X)%s\n#include "support/together.h"\n' \
    '$(foreach test,$(1), X($(call main_of,$(test)),"$(patsubst tests/%,%,$(test))"))' >$@.new
@cmp -s $@.new $@ || cp $@.new $@
endef
$(B)/tests/program_tests.c: FORCE
	$(call list_tests,$(PROGRAM_TOGETHER))
$(B)/tests/library_tests.c: FORCE
	$(call list_tests,$(LIBRARY_TOGETHER))
$(B)/obj/tests/%_tests.o: $(B)/tests/%_tests.c tests/support/together.h
	$(call compile,CC ,$(CC),$(CFLAGS))
$(B)/tests/program_tests: $(B)/obj/tests/program_tests.o $(PROGRAM_TOGETHER:%=$(B)/obj/%.o) $(filter-out $(B)/obj/lib/app/main.o,$(PROGRAM_OBJECTS)) $(B)/libwaferhand_lcm.a
$(B)/tests/program_tests: LIBS = $(PROGRAM_LIBS)
$(B)/tests/library_tests: $(B)/obj/tests/library_tests.o $(LIBRARY_TOGETHER:%=$(B)/obj/%.o)
$(B)/tests/program_tests $(if $(FLOAT),,$(B)/tests/library_tests): $(B)/libwaferhand_collision.a
$(B)/tests/program_tests $(if $(FLOAT),,$(B)/tests/library_tests): COLLISION = $(COLLISION_LIBS)
define share_program
@mkdir -p $(@D)
@ln -f $< $@
endef
$(PROGRAM_TOGETHER:%=$(B)/%): $(B)/tests/program_tests
	$(share_program)
$(LIBRARY_TOGETHER:%=$(B)/%): $(B)/tests/library_tests
	$(share_program)

# ------------------------------------------------------------------------------------------------- lcm-spy
# lcm-gen's classes are not clean under javac's warnings, but ours are.
SPY_SOURCES := $(wildcard lib/spy/*.java)
LCM_JAR = $(firstword $(wildcard /usr/share/java/lcm.jar /usr/local/share/java/lcm.jar))
$(B)/spy/types.jar: $(MESSAGES:%=lcm_types/%.lcm) $(SPY_SOURCES) $(B)/messages
	@echo "  JAVA $@"
	@rm -rf $(@D) && mkdir -p $(@D)/classes
	$(Q)lcm-gen -j --jpath $(@D) $(filter %.lcm,$^)
	$(Q)javac -nowarn -cp $(LCM_JAR) -d $(@D)/classes $(@D)/waferhand/*.java
	$(Q)javac -encoding UTF-8 -Xlint:all $(if $(WERROR),-Werror) -cp $(@D)/classes:$(LCM_JAR) -d $(@D)/classes \
	    $(SPY_SOURCES)
	$(Q)jar cf $@ -C $(@D)/classes waferhand
spy: $(B)/spy/types.jar

# ----------------------------------------------------------------------------------- manual, installing
# The manual's table of errors comes from lib/math/status.def, its exit statuses from lua/manual/reports.md.
$(B)/waferhand.1: lib/build/waferhand.1.in lib/math/status.def lib/math/config.h lua/manual/reports.md
	@awk -F ' *[|] *' '/^## / { on = $$0 == "## Exit status" } on && $$3 ~ /^[0-9]+$$/ \
	    { gsub(/`/, ""); gsub(/-/, "\\-"); print ".TP\n.B " $$2 " " $$3 "\n" $$4 }' lua/manual/reports.md >$@.exits
	@sed -n 's/^WH_STATUS(\([1-9][0-9]*\), \([A-Z_]*\), "\(.*\)")$$/.TP\n.B \1 \2\n\3/p' lib/math/status.def >$@.errors
	@sed -e 's/@version@/$(VERSION)/' -e '/@errors@/{r $@.errors' -e 'd}' -e '/@exits@/{r $@.exits' -e 'd}' lib/build/waferhand.1.in >$@

include lib/build/install.mk tests/check/check.mk tests/fuzz/fuzz.mk tests/bench/bench.mk lib/build/playground.mk
