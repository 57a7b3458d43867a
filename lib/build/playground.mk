# The playground: the engine as WebAssembly, and one page with it. `make playground` alone needs emscripten.

.PHONY: playground
PLAYGROUND := $(B)/playground
EMCC ?= emcc
# emcc compiles by this compiler; its flags come from emcc.
EMCLANG ?= clang-14
# Debian's libraries for WebAssembly are taken as they are.
export EM_FROZEN_CACHE := 1
playground: $(B)/playground.html

# ------------------------------------------------------------------------------------ sources of libraries
EM_SOURCES := $(PLAYGROUND)/src
$(EM_SOURCES)/sources.sha256: lib/playground/sources.sha256 lib/playground/fetch
	@lib/playground/fetch $(EM_SOURCES)
	@touch $@

# Their files are known only once they are there, so make asks by these lists.
EM_LUA := $(addprefix lua5.4/src/,$(addsuffix .c,lapi lauxlib lbaselib lcode lcorolib lctype ldblib ldebug ldo ldump lfunc lgc linit \
          liolib llex lmathlib lmem loadlib lobject lopcodes loslib lparser lstate lstring lstrlib ltable ltablib ltm lundump \
          lutf8lib lvm lzio))
EM_OTHERS := $(addprefix libccd/src/,$(addsuffix .c,ccd mpr polytope support vec3)) \
          $(addprefix jansson/src/,$(addsuffix .c,dump error hashtable hashtable_seed load memory pack_unpack strbuffer strconv utf value)) \
          $(addprefix zlib/,$(addsuffix .c,adler32 compress crc32 deflate trees zutil)) \
          $(addprefix qhull/src/libqhull_r/,$(addsuffix .c,geom2_r geom_r global_r io_r libqhull_r mem_r merge_r poly2_r poly_r qset_r \
          random_r rboxlib_r stat_r user_r usermem_r userprintf_r userprintf_rbox_r))
EM_CXX := $(addprefix urdfdom/urdf_parser/src/,$(addsuffix .cpp,joint link model pose world)) \
          $(addprefix tinyxml/,$(addsuffix .cpp,tinystr tinyxml tinyxmlerror tinyxmlparser)) console-bridge/src/console.cpp
EM_INCLUDES := $(addprefix -isystem $(EM_SOURCES)/,lua5.4/src libccd/src jansson/src zlib qhull/src tinyxml console-bridge/include \
          urdfdom/urdf_parser/include $(addprefix urdfdom-headers/,urdf_exception/include urdf_model/include urdf_model_state/include \
          urdf_sensor/include urdf_world/include))

# ------------------------------------------------------------------------------------------- sources of ours
# The parts of the program that a script's run goes by. An archive holds them, so that the linker takes what is called.
EM_ROOMS := $(LIBRARY_ROOMS) $(COLLISION_ROOM) text flow script layout bodies reading record trial mcs scene report play print
EM_OURS := $(filter-out $(addprefix lib/,text/options.c text/guard.c $(addprefix report/,gnuplot.c plots.c sweep_plot.c \
          $(notdir $(wildcard lib/report/plot_*.c)) study_document.c) print/best_print.c $(addprefix print/,$(notdir $(wildcard \
          $(addprefix lib/print/,budget_*.c estimate_*.c layout_*.c lines_*.c paces_*.c schedule_*.c slices_*.c study_*.c sweep_*.c \
          tests_*.c))))),$(wildcard $(addprefix lib/,$(addsuffix /*.c,$(EM_ROOMS) playground))))
EM_OURS_CXX := $(wildcard lib/bodies/*.cpp)

EM_OBJECTS := $(EM_OURS:%.c=$(PLAYGROUND)/obj/%.o) $(EM_OURS_CXX:%.cpp=$(PLAYGROUND)/obj/%.o) \
          $(addprefix $(PLAYGROUND)/obj/,embedded_lua.o embedded_page.o)
EM_FOREIGN := $(EM_LUA:%.c=$(PLAYGROUND)/obj/src/%.o) $(EM_OTHERS:%.c=$(PLAYGROUND)/obj/src/%.o) $(EM_CXX:%.cpp=$(PLAYGROUND)/obj/src/%.o)

# ---------------------------------------------------------------------------------------------- compiling
# What the program has, but for the headers; size_t has 32 bits here, so conversions that are none elsewhere are not warned of.
EM_BITS := -O2 -ffp-contract=off -fno-math-errno -fno-builtin-pow -DWH_NO_CONTRACTION
EM_FLAGS := $(EM_BITS) -D_GNU_SOURCE -Wall -Wextra -Wno-missing-field-initializers $(if $(WERROR),-Werror) $(EM_INCLUDES) \
          '-DWH_JAVASCRIPT="/javascript"'
EM_CALL = $(Q)$(CCACHE) $(EMCLANG) $(EM_TARGET) $(1) $(DEPENDENCIES) -c -o $@ $<
EM_TARGET = $(eval EM_TARGET := $$(shell $(EMCC) --cflags))$(EM_TARGET)
define em_compile
@mkdir -p $(@D)
@echo "  WASM $<"
$(call EM_CALL,$(1))
endef
$(PLAYGROUND)/obj/lib/%.o: lib/%.c $(PLAYGROUND)/flags $(EM_SOURCES)/sources.sha256
	$(call em_compile,-std=c99 $(EM_FLAGS))
$(PLAYGROUND)/obj/lib/%.o: lib/%.cpp $(PLAYGROUND)/flags $(EM_SOURCES)/sources.sha256
	$(call em_compile,-std=c++17 -fexceptions $(EM_FLAGS))
$(PLAYGROUND)/obj/embedded_%.o: $(B)/embedded_%.c
	$(call em_compile,-std=c99 $(EM_FLAGS) -I.)
$(EM_FOREIGN): $(EM_SOURCES)/sources.sha256
$(EM_LUA:%.c=$(PLAYGROUND)/obj/src/%.o) $(EM_OTHERS:%.c=$(PLAYGROUND)/obj/src/%.o): $(PLAYGROUND)/obj/src/%.o:
	$(call em_foreign,$*.c,-std=gnu99 -DLUA_COMPAT_5_3 -DHAVE_STDINT_H)
$(EM_CXX:%.cpp=$(PLAYGROUND)/obj/src/%.o): $(PLAYGROUND)/obj/src/%.o:
	$(call em_foreign,$*.cpp,-std=c++14 -fexceptions)
define em_foreign
@mkdir -p $(@D)
@echo "  WASM $(1)"
$(Q)$(CCACHE) $(EMCLANG) $(EM_TARGET) $(2) $(EM_BITS) -w $(EM_INCLUDES) -c -o $@ $(EM_SOURCES)/$(1)
endef
-include $(shell find $(PLAYGROUND)/obj -name '*.d' 2>/dev/null)

# ------------------------------------------------------------------------------------------------ linking
EM_CALLS := run json document report page definitions reason
empty :=
EM_EXPORTS := $(subst $(empty) ,$(comma),$(EM_CALLS:%=_wh_playground_%))
EM_LINK := -O2 -fexceptions -Wl,--wrap=pow -sMODULARIZE=1 -sEXPORT_NAME=WaferhandEngine -sENVIRONMENT=worker,node \
          -sALLOW_MEMORY_GROWTH=1 -sINITIAL_MEMORY=67108864 -sMAXIMUM_MEMORY=2147483648 -sTOTAL_STACK=8388608 -sFORCE_FILESYSTEM=1 \
          -sEXPORTED_RUNTIME_METHODS=FS,ccall -sEXPORTED_FUNCTIONS=$(EM_EXPORTS) -sNODEJS_CATCH_EXIT=0 -sNODEJS_CATCH_REJECTION=0
# For make, the objects of an archive that is newer than their sources need not exist.
$(PLAYGROUND)/list: TEXT = $(EM_OBJECTS) $(EM_FOREIGN) $(EM_LINK)
$(PLAYGROUND)/flags: TEXT = $(EMCC) $(EMCLANG) $(EM_FLAGS)
$(PLAYGROUND)/list $(PLAYGROUND)/flags: FORCE
	@mkdir -p $(@D)
	@printf '%s\n' '$(subst ','\'',$(TEXT))' | cmp -s - $@ || printf '%s\n' '$(subst ','\'',$(TEXT))' >$@
$(PLAYGROUND)/engine.a: $(EM_OBJECTS) $(EM_FOREIGN) $(PLAYGROUND)/list
	@echo "  AR   $@"
	@printf '%s\n' $(filter %.o,$^) >$(PLAYGROUND)/objects
	$(Q)rm -f $@ && emar qcs $@ @$(PLAYGROUND)/objects
$(PLAYGROUND)/engine.js: $(PLAYGROUND)/engine.a lib/build/playground.mk
	@echo "  WASM $@"
	$(Q)NODE_PATH=/usr/share/nodejs $(EMCC) $(EM_LINK) -o $@ $<

# ------------------------------------------------------------------------------------------------- the page
EM_FILES := $(filter lua/examples/% lua/layouts/% lua/patterns/%,$(LUA_SOURCES)) $(wildcard lua/layouts/*.urdf lua/layouts/*.stl)
EM_PAGE := $(wildcard lib/playground/page/*)
$(B)/playground.html: $(PLAYGROUND)/engine.js lib/playground/assemble.js lib/playground/worker.js $(EM_PAGE) $(EM_FILES)
	@echo "  PAGE $@"
	$(Q)node lib/playground/assemble.js $(PLAYGROUND) $(JAVASCRIPT) $(VERSION) $@ $(EM_FILES)
