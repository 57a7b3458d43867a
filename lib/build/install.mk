# The places of files on an installed system.

# Installed files name these places, so the names are absolute. They have no blanks, since make ends a name at a blank.
$(foreach place,PREFIX LIBDIR,\
    $(if $(filter-out 0 1,$(words $($(place)))),$(error $(place)=: a path without a blank, not "$($(place))")) \
    $(eval override $(place) := $(abspath $($(place)))))

INCLUDES := $(PREFIX)/include/waferhand
# Two headers of one line each, beside the tree: <waferhand.h> and <waferhand_collision.h>.
public = $(filter-out %_internal.h,$(foreach room,$(1),$(wildcard lib/$(room)/*.h lib/$(room)/*.def)))

# The library is one part, and collision is the second; `make install` adds the program and the rest.
SHARED_LIBRARY := $(if $(SHARED),$(LIBDIR)/libwaferhand.so.$(ABI))
CMAKE := $(LIBDIR)/cmake/waferhand/waferhand-config
LIBRARY_PLACES := $(LIBDIR)/libwaferhand.a $(SHARED_LIBRARY) $(LIBDIR)/waferhand/interface.json $(LIBDIR)/pkgconfig/waferhand.pc $(CMAKE).cmake $(CMAKE)-version.cmake
LIBRARY_HEADERS := lib/waferhand.h $(call public,$(LIBRARY_ROOMS))
SHARED_COLLISION := $(if $(SHARED),$(LIBDIR)/libwaferhand_collision.so.$(ABI))
COLLISION_PLACES := $(LIBDIR)/libwaferhand_collision.a $(SHARED_COLLISION) $(LIBDIR)/waferhand/interface_collision.json $(LIBDIR)/pkgconfig/waferhand_collision.pc
COLLISION_HEADERS := lib/waferhand_collision.h $(call public,$(COLLISION_ROOM))
PROGRAM_PLACES := $(PREFIX)/bin/waferhand $(LIBDIR)/lua/5.4/wh.so $(PREFIX)/share/man/man1/waferhand.1 \
                  $(if $(RANKS),$(LIBDIR)/waferhand/waferhand_mpi.so)
PLACES := $(LIBRARY_PLACES) $(COLLISION_PLACES) $(PROGRAM_PLACES)
SHARE := $(PREFIX)/share/waferhand
DOCUMENTS := $(PREFIX)/share/doc/waferhand
EXAMPLES := $(filter lua/layouts/% lua/examples/% lua/patterns/% lua/dialects/% lua/schedules/%,$(LUA_SOURCES)) \
            $(wildcard lua/schedules/*.csv)
# The manuals as they stand in the tree, so that the links between them lead somewhere. Other programs are generated from the messages;
# a controller's board compiles board.c.
MANUALS := README.md LICENSE $(wildcard lib/*.md lib/manual/*.md lib/*/README.md lua/*.md lua/manual/* lua/dialects/*.md \
           lcm_types/*.md lcm_types/*.lcm tests/README.md lib/loop/board.[ch] lib/*/*.png lib/*/*/*.png lua/layouts/*.svg)

# $(call place,FILE,PLACE): a step of a chain of commands that stops at the first failure
place = install -D -m $(if $(filter %/bin/waferhand,$(2)),755,644) $(1) '$(DESTDIR)$(2)' &&
places = $(foreach to,$(1),$(call place,$(B)/$(notdir $(to)),$(to)))
headers = $(foreach file,$(1),$(call place,$(file),$(INCLUDES)/$(file:lib/%=%)))
entry = $(call place,lib/include/$(1).h,$(PREFIX)/include/$(1).h)

install: install-library install-collision
	@$(call places,$(PROGRAM_PLACES)) $(foreach file,$(EXAMPLES),$(call place,$(file),$(SHARE)/$(file:lua/%=%))) \
	    $(foreach file,$(MANUALS),$(call place,$(file),$(DOCUMENTS)/$(file))) \
	    if [ -e $(B)/playground/report_engine.html ]; then $(call place,$(B)/playground/report_engine.html,$(SHARE)/report_engine.html) true; fi && \
	    if [ -e $(B)/manual/index.html ]; then mkdir -p '$(DESTDIR)$(DOCUMENTS)/html' && cp -R $(B)/manual/. '$(DESTDIR)$(DOCUMENTS)/html'; fi && \
	    echo 'installed into $(DESTDIR)$(PREFIX)'

install-library: $(foreach to,$(LIBRARY_PLACES),$(B)/$(notdir $(to)))
	@$(call places,$(LIBRARY_PLACES)) $(call headers,$(LIBRARY_HEADERS)) $(call entry,waferhand) \
	    $(if $(SHARED),ln -sf $(notdir $(SHARED_LIBRARY)) '$(DESTDIR)$(LIBDIR)/libwaferhand.so' &&) \
	    echo 'library installed into $(DESTDIR)$(PREFIX)'

install-collision: $(foreach to,$(COLLISION_PLACES),$(B)/$(notdir $(to)))
	@$(call places,$(COLLISION_PLACES)) $(call headers,$(COLLISION_HEADERS)) $(call entry,waferhand_collision) \
	    $(if $(SHARED),ln -sf $(notdir $(SHARED_COLLISION)) '$(DESTDIR)$(LIBDIR)/libwaferhand_collision.so',true)

# The way from LIBDIR/cmake/waferhand to the headers, so that the installed tree can be moved as a whole.
UPWARDS := $(if $(filter $(PREFIX)/%,$(LIBDIR)),../../$(subst $() ,/,$(patsubst %,..,$(subst /, ,$(LIBDIR:$(PREFIX)/%=%)))))
FILLED := waferhand.pc waferhand_collision.pc waferhand-config.cmake waferhand-config-version.cmake
$(FILLED:%=$(B)/%): $(B)/%: lib/build/%.in FORCE
	@mkdir -p $(@D)
	@sed -e 's|@prefix@|$(PREFIX)|' -e 's|@libdir@|$(LIBDIR)|' -e 's|@version@|$(VERSION)|' -e 's|@abi@|$(ABI)|g' \
	    -e 's|@flags@|$(SAME_BITS)|' -e 's|@defines@|$(DEFINES)|' \
	    -e 's|@include@|$(if $(UPWARDS),$${CMAKE_CURRENT_LIST_DIR}/$(UPWARDS),$(PREFIX))/include|' $< >$@

uninstall:
	rm -f $(PLACES:%='$(DESTDIR)%') '$(DESTDIR)$(LIBDIR)'/libwaferhand.so* '$(DESTDIR)$(LIBDIR)'/libwaferhand_collision.so* $(foreach entry,waferhand waferhand_collision,'$(DESTDIR)$(PREFIX)/include/$(entry).h')
	rm -rf '$(DESTDIR)$(INCLUDES)' '$(DESTDIR)$(DOCUMENTS)' '$(DESTDIR)$(SHARE)' '$(DESTDIR)$(dir $(CMAKE))'
