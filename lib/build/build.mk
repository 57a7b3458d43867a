# What is made from what, below B. Called by the Makefile, once everything it needs is installed.

B := build
include lib/build/switches.mk
CFLAGS ?= -O2 -g
# Line numbers alone: all that debuggers are told of Eigen's templates is many times the code.
CXXFLAGS ?= -O2 -g1
PKG_CONFIG ?= pkg-config
PREFIX ?= /usr/local
LIBDIR ?= $(PREFIX)/lib
JAVASCRIPT ?= /usr/share/javascript
WERROR ?= $(if $(CI),1)
Q := $(if $(V),,@)
# A cross compiler's own, where none is given: arm-none-eabi-gcc-ar beside arm-none-eabi-gcc.
ifeq ($(origin AR),default)
AR := $(patsubst %gcc,%gcc-ar,$(firstword $(filter %-gcc,$(CC))))
AR := $(or $(AR),ar)
endif

# Of lib/math/config.h
defined = $(shell sed -n 's/^.define $(1) //p' lib/math/config.h)
VERSION := $(call defined,WH_VERSION_MAJOR).$(call defined,WH_VERSION_MINOR).$(call defined,WH_VERSION_PATCH)

# ---------------------------------------------------------------------------------------------- sources
include tests/tests.mk
LIBRARY_SOURCES := $(wildcard $(LIBRARY_ROOMS:%=lib/%/*.c))
COLLISION_SOURCES := $(wildcard lib/$(COLLISION_ROOM)/*.c)
MODULE_SOURCES := $(wildcard lib/script/wh_module*.c)
# Loaded by itself, under mpirun.
RANKS_SOURCE := lib/study/ranks_mpi.c
PROGRAM_SOURCES := $(filter-out $(RANKS_SOURCE),$(wildcard $(HOST_ROOMS:%=lib/%/*.c) lib/app/prompt/*.c))
PROGRAM_CXX_SOURCES := $(wildcard $(HOST_ROOMS:%=lib/%/*.cpp))
MESSAGES := $(patsubst lcm_types/%.lcm,%,$(wildcard lcm_types/*.lcm))
LUA_SOURCES := $(sort $(shell find lua -name '*.lua' 2>/dev/null))
PAGE_SOURCES := $(sort $(wildcard lib/report/page/*))
HEADERS := $(wildcard lib/*.h lib/*/*.h lib/*/*/*.h lib/*/*.def)

LIBRARY_OBJECTS := $(LIBRARY_SOURCES:%.c=$(B)/obj/%.o)
COLLISION_OBJECTS := $(COLLISION_SOURCES:%.c=$(B)/obj/%.o)
PROGRAM_CXX_OBJECTS := $(PROGRAM_CXX_SOURCES:%.cpp=$(B)/obj/%.o)
PROGRAM_OBJECTS := $(PROGRAM_SOURCES:%.c=$(B)/obj/%.o) $(PROGRAM_CXX_OBJECTS) $(B)/obj/embedded_lua.o $(B)/obj/embedded_page.o
MESSAGE_SOURCES := $(MESSAGES:%=$(B)/lcm/waferhand_%.c)
MESSAGE_OBJECTS := $(MESSAGE_SOURCES:$(B)/%.c=$(B)/obj/%.o)
MODULE_OBJECTS := $(MODULE_SOURCES:%.c=$(B)/pic/%.o)
MODULE_SUPPORT := $(LIBRARY_SOURCES:%.c=$(B)/pic/%.o)

# ------------------------------------------------------------------------------------------------ flags
# Any C compiler builds the library: what only gcc and clang know is for them, and what only newer ones know for those.
GNU := $(findstring __GNUC__,$(shell $(CC) -dM -E -x c /dev/null 2>/dev/null))
accepts = $(shell $(CC) $(1) -E -x c /dev/null >/dev/null 2>&1 && echo $(1))
WARNINGS := -Wall -Wextra -Wpedantic -Wshadow -Wundef -Wcast-align -Wcast-qual -Wformat=2 -Wvla -Wswitch-enum \
            -Wwrite-strings -Wsign-conversion
C_WARNINGS := -Wstrict-prototypes -Wmissing-prototypes
# Not for a float build's tests, which compare in double on purpose.
NUMBER_WARNINGS := -Wconversion -Wdouble-promotion

# Contraction to fused multiply-adds would change bits from machine to machine, and gcc 12's vectoriser of straight code
# fuses a*b + c*d beside e*f - g*h whatever it was told; errno keeps sqrt from being one instruction. Users of the library
# compile with these as well.
SAME_BITS := -ffp-contract=off -fno-tree-slp-vectorize -fno-math-errno -DWH_NO_CONTRACTION
$(if $(filter-out sweep index,$(WITHOUT)),$(error WITHOUT=: of "sweep" and "index", not "$(WITHOUT)"))
SETTINGS := $(strip $(if $(FLOAT),-DWH_FLOAT) $(addprefix -DWH_WITHOUT_,$(shell echo '$(WITHOUT)' | tr a-z A-Z)))
# What the users of the library have to define as well: number type and what is left out, be it said by FLOAT and WITHOUT,
# in CFLAGS, or in the header that WH_CONFIG_FILE names.
DEFINES := $(if $(GNU),$(shell $(CC) $(CFLAGS) $(EXTRA) $(SETTINGS) -ffreestanding -dM -E lib/math/config.h 2>/dev/null | \
    sed -nE 's/^.define (WH_FLOAT|WH_WITHOUT_SWEEP|WH_WITHOUT_INDEX|WH_MOST_AXES|WH_MOST_GRIPPERS)\b ?(.*)$$/-D\1=\2/p' | sed 's/=1$$//' | sort),$(SETTINGS))
ABI := $(call defined,WH_ABI)$(if $(filter -DWH_FLOAT%,$(DEFINES)),f)
# The prefix map keeps the folder's name out of what is built.
BASE := $(SAME_BITS) $(call accepts,-ffile-prefix-map=$(CURDIR)=.) $(WARNINGS) \
        $(if $(WERROR),-Werror) $(SETTINGS)
LIBRARY_FLAGS := $(if $(GNU),-std=c99 $(BASE) $(C_WARNINGS) $(NUMBER_WARNINGS),$(SETTINGS)) -DWH_BUILDING_LIBRARY
COLLISION_FLAGS = $(LIBRARY_FLAGS) $(call package_flags,ccd)
HOST_FLAGS := -std=c99 -D_GNU_SOURCE $(BASE) $(C_WARNINGS)

# What lcm-gen writes is not clean under our warnings; nor are its headers, and those of other packages, ours to
# warn about.
MESSAGE_FLAGS := -std=c99 -D_GNU_SOURCE -ffile-prefix-map=$(CURDIR)=.
LCM_FLAGS := -isystem $(B)/lcm
package_flags = $(patsubst -I%,-isystem %,$(shell $(PKG_CONFIG) --cflags $(1) 2>/dev/null))
LUA := $(firstword $(foreach name,lua5.4 lua-5.4 lua54 lua,$(shell $(PKG_CONFIG) --exists $(name) 2>/dev/null && echo $(name))))
# liburdfdom's pkg-config file may name /usr/include itself, which is to stay behind C++'s own folders.
URDF_FLAGS := $(patsubst -I%,-idirafter %,$(shell $(PKG_CONFIG) --cflags urdfdom tinyxml qhull_r 2>/dev/null))
PROGRAM_FLAGS := $(HOST_FLAGS) $(NUMBER_WARNINGS) $(LCM_FLAGS) $(call package_flags,$(LUA) jansson smartcols libedit zlib libzstd) $(URDF_FLAGS)
# Eigen without its heap, which no matrix of ours needs: what throws or asks for C++'s own library is left out, and C links it.
PROGRAM_CXX_FLAGS := -std=c++17 -fno-exceptions -fno-rtti $(BASE) $(NUMBER_WARNINGS) -DEIGEN_NO_MALLOC -DEIGEN_MPL2_ONLY $(call package_flags,eigen3)
TEST_FLAGS := $(HOST_FLAGS) $(if $(FLOAT),,$(NUMBER_WARNINGS)) -Ilib -Itests $(LCM_FLAGS) $(call package_flags,$(LUA) jansson)
CXX_TEST_FLAGS := -std=c++17 $(BASE) -Ilib -Itests $(call package_flags,eigen3)

# Lua comes from its static archive, so that its `^` calls the program's own pow and not libm's.
LUA_ARCHIVE = $(firstword $(filter /%,$(foreach name,liblua5.4.a liblua-5.4.a liblua.a,\
                $(shell $(CC) -print-file-name=$(name)))))
# Open MPI, where it is.
MPI := $(firstword $(foreach name,ompi-c ompi,$(shell $(PKG_CONFIG) --exists $(name) 2>/dev/null && echo $(name))))
RANKS := $(if $(MPI),$(B)/waferhand_mpi.so)

# liburdfdom is C++; C links it all the same.
URDF_LIBS = -Wl,--as-needed $(shell $(PKG_CONFIG) --libs urdfdom tinyxml qhull_r) -lstdc++ -Wl,--no-as-needed
# LCM's pkg-config file asks for GLib's headers, which its own do not need: hence -llcm.
# Before libwaferhand.a, which it uses.
COLLISION_LIBS = $(B)/libwaferhand_collision.a -Wl,--as-needed $(shell $(PKG_CONFIG) --libs-only-l ccd) -Wl,--no-as-needed
PROGRAM_LIBS = $(B)/libwaferhand_lcm.a $(LUA_ARCHIVE) $(shell $(PKG_CONFIG) --libs jansson smartcols libedit zlib libzstd) $(URDF_LIBS) -llcm -ldl -lpthread -lm

# Written when its text changes: what depends on it is rebuilt when a flag or the set of files changes.
STAMP := $(CC) $(CXX) $(CFLAGS) $(CXXFLAGS) $(LDFLAGS) $(EXTRA) $(COLLISION_FLAGS) $(PROGRAM_FLAGS) $(TEST_FLAGS) \
         $(CXX_TEST_FLAGS) $(PROGRAM_CXX_FLAGS) $(MESSAGE_FLAGS) $(JAVASCRIPT)
$(B)/flags: TEXT = $(STAMP)
$(B)/sources: TEXT = $(LIBRARY_SOURCES) $(COLLISION_SOURCES) $(PROGRAM_SOURCES) $(PROGRAM_CXX_SOURCES) $(LUA_SOURCES) $(PAGE_SOURCES)
$(B)/messages: TEXT = $(MESSAGES)
$(B)/flags $(B)/sources $(B)/messages: FORCE
	@mkdir -p $(@D)
	@printf '%s\n' '$(TEXT)' | cmp -s - $@ || printf '%s\n' '$(TEXT)' >$@

# ---------------------------------------------------------------------------------------------- targets
.PHONY: all library collision program ranks spy tests library-tests library-test-names install uninstall FORCE
.DELETE_ON_ERROR:
.SECONDARY:

all: library collision $(B)/waferhand $(B)/wh.so $(B)/waferhand.1 ranks
library: $(B)/libwaferhand.a
shared: $(B)/libwaferhand.so.$(ABI)
collision: $(B)/libwaferhand_collision.a
program: $(B)/waferhand
ranks: $(RANKS)
tests: $(TESTS:%=$(B)/%) $(TOOLS:%=$(B)/%) $(BENCHES:%=$(B)/%)
	@:
library-tests: $(LIBRARY_TESTS:%=$(B)/%)
	@:
library-test-names:
	@echo $(LIBRARY_TESTS)

# ------------------------------------------------------------------------------------------- compiling
$(LIBRARY_OBJECTS): FLAGS = $(LIBRARY_FLAGS)
$(COLLISION_OBJECTS): FLAGS = $(COLLISION_FLAGS)
# Its loops are short and many: a twentieth of a run's time.
$(COLLISION_OBJECTS): CFLAGS := $(CFLAGS:-O2=-O3)
$(PROGRAM_OBJECTS): FLAGS = $(PROGRAM_FLAGS)
$(PROGRAM_CXX_OBJECTS): FLAGS = $(PROGRAM_CXX_FLAGS)
$(LIBRARY_SOURCES:%.c=$(B)/pic/%.o): FLAGS = $(LIBRARY_FLAGS) -fPIC -fvisibility=hidden
$(MODULE_OBJECTS): FLAGS = $(PROGRAM_FLAGS) -fPIC
$(B)/obj/lib/report/page.o: FLAGS += -DWH_JAVASCRIPT='"$(JAVASCRIPT)"'
# liburdfdom's headers throw.
$(B)/obj/lib/layout/urdf_file.o: FLAGS += -fexceptions -frtti $(URDF_FLAGS)
# Its pow must not be taken for the one that the compiler knows.
$(B)/obj/lib/script/pow.o: FLAGS += -fno-builtin-pow
$(B)/obj/tests/%.o: FLAGS = $(TEST_FLAGS)
$(CXX_TESTS:%=$(B)/obj/%.o): FLAGS = $(CXX_TEST_FLAGS)

define compile
@mkdir -p $(@D)
@echo "  $(1)  $<"
$(Q)$(2) $(FLAGS) $(3) $(EXTRA) $(if $(GNU),-MMD -MP) -c -o $@ $<
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
$(B)/embedded_lua.c: lib/build/embed $(LUA_SOURCES) $(B)/sources
	@lib/build/embed wh_embedded lua/ $(LUA_SOURCES) >$@
$(B)/embedded_page.c: lib/build/embed $(PAGE_SOURCES) $(B)/sources
	@lib/build/embed wh_embedded_page lib/report/page/ $(PAGE_SOURCES) >$@

# All at once, and anew, so that none is left of a message that is gone. waferhand_messages.h gathers the others and
# lists them: WAFERHAND_MESSAGES(X) is X(cell) X(command) and so on.
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
$(filter $(foreach room,link log view study report print app,$(B)/obj/lib/$(room)/%),$(PROGRAM_OBJECTS)) $(PROGRAM_TESTS:%=$(B)/obj/%.o) $(TOOLS:%=$(B)/obj/%.o): \
    $(B)/lcm/waferhand_messages.h

-include $(shell find $(B)/obj $(B)/pic -name '*.d' 2>/dev/null)

# --------------------------------------------------------------------------------------------- linking
# Made anew and with q: r would replace the first of two members that have the same base name.
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
# Shows what public headers declare, and nothing else. Its name for the loader has the ABI, and the number type if that is float.
$(B)/libwaferhand.so.$(ABI): $(MODULE_SUPPORT) $(B)/sources
	@echo "  LD   $@"
	$(LINK) -shared -Wl,-soname,libwaferhand.so.$(ABI),-z,defs,--as-needed -o $@ $(MODULE_SUPPORT) -lm
	@ln -sf $(@F) $(@D)/libwaferhand.so
$(B)/pic/support.a: $(MODULE_SUPPORT) $(B)/sources
	$(archive)

LINK = $(Q)$(CC) $(CFLAGS) $(EXTRA) $(LDFLAGS)

# -E: native modules that a trusted script loads look for Lua in the program.
$(B)/waferhand: $(PROGRAM_OBJECTS) $(B)/libwaferhand.a $(B)/libwaferhand_collision.a $(B)/libwaferhand_lcm.a $(B)/sources
	@echo "  LD   $@"
	$(LINK) -Wl,-E -o $@ $(PROGRAM_OBJECTS) $(COLLISION_LIBS) $(B)/libwaferhand.a $(PROGRAM_LIBS)

# What speaks MPI is apart, so that the program does not depend on it: loaded under mpirun only, built where MPI is.
$(RANKS_SOURCE:%.c=$(B)/pic/%.o): FLAGS = $(HOST_FLAGS) -fPIC $(NUMBER_WARNINGS) $(call package_flags,$(MPI))
$(B)/waferhand_mpi.so: $(RANKS_SOURCE:%.c=$(B)/pic/%.o)
	@echo "  LD   $@"
	$(LINK) -shared -o $@ $< $(shell $(PKG_CONFIG) --libs $(MPI))

# Lua's own symbols come from the interpreter that loads it, hence -z now: a missing one shows at once. Only
# the module's own symbols go out.
$(B)/wh.so: $(MODULE_OBJECTS) $(B)/pic/support.a
	@echo "  LD   $@"
	$(LINK) -shared -Wl,-z,now,--exclude-libs,ALL,--as-needed -o $@ $^ -lm

$(PROGRAM_TESTS:%=$(B)/%) $(TOOLS:%=$(B)/%): $(filter-out $(B)/obj/lib/app/main.o,$(PROGRAM_OBJECTS)) $(B)/libwaferhand_lcm.a
$(PROGRAM_TESTS:%=$(B)/%) $(TOOLS:%=$(B)/%): LIBS = $(PROGRAM_LIBS)
COLLISION_USERS := $(foreach user,$(PROGRAM_TESTS) $(COLLISION_TESTS) $(TOOLS) $(BENCHES),$(B)/$(user))
$(COLLISION_USERS): $(B)/libwaferhand_collision.a
$(COLLISION_USERS): COLLISION = $(COLLISION_LIBS)
# The firmware under test stands beside its tests.
$(filter $(B)/tests/firmware/%,$(TESTS:%=$(B)/%)): $(B)/obj/tests/firmware/controller.o
$(B)/tests/property/chain_random: LIBS = $(shell pkg-config --libs orocos-kdl)
$(CXX_TESTS:%=$(B)/%): LINK = $(Q)$(CXX) $(CXXFLAGS) $(EXTRA) $(LDFLAGS)
$(B)/tests/%: $(B)/obj/tests/%.o $(B)/libwaferhand.a
	@mkdir -p $(@D)
	@echo "  LD   $@"
	$(LINK) -o $@ $(filter %.o,$^) $(COLLISION) $(B)/libwaferhand.a $(LIBS) -lcmocka -lm

# ------------------------------------------------------------------------------------------------- lcm-spy
# lcm-gen's classes are not clean under javac's warnings; ours are.
SPY_SOURCES := $(wildcard lib/link/spy/*.java)
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
# The manual's table of errors is lib/math/status.def, its exit statuses are those of lua/README.md.
$(B)/waferhand.1: lib/build/waferhand.1.in lib/math/status.def lib/math/config.h lua/README.md
	@awk -F ' *[|] *' '/^## / { on = $$0 == "## Exit status" } on && $$3 ~ /^[0-9]+$$/ \
	    { gsub(/`/, ""); gsub(/-/, "\\-"); print ".TP\n.B " $$2 " " $$3 "\n" $$4 }' lua/README.md >$@.exits
	@sed -n 's/^WH_STATUS(\([1-9][0-9]*\), \([A-Z_]*\), "\(.*\)")$$/.TP\n.B \1 \2\n\3/p' lib/math/status.def >$@.errors
	@sed -e 's/@version@/$(VERSION)/' -e '/@errors@/{r $@.errors' -e 'd}' -e '/@exits@/{r $@.exits' -e 'd}' lib/build/waferhand.1.in >$@

include lib/build/install.mk tests/check/check.mk tests/fuzz/fuzz.mk tests/bench/bench.mk
