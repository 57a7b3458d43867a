# Where things go on a system.

PLACES := $(PREFIX)/bin/waferhand $(LIBDIR)/libwaferhand.a $(LIBDIR)/libwaferhand_collision.a \
          $(LIBDIR)/lua/5.4/wh.so $(LIBDIR)/pkgconfig/waferhand.pc $(LIBDIR)/pkgconfig/waferhand_collision.pc \
          $(PREFIX)/share/man/man1/waferhand.1 $(if $(RANKS),$(LIBDIR)/waferhand/waferhand_mpi.so)
INCLUDES := $(PREFIX)/include/waferhand
# One line each, beside the tree: <waferhand.h> and <waferhand_collision.h>.
ENTRIES := $(wildcard lib/build/*.h)
PUBLIC := $(filter-out %_internal.h,$(wildcard lib/*.h $(foreach room,$(LIBRARY_ROOMS) $(COLLISION_ROOM),lib/$(room)/*.h lib/$(room)/*.def)))
SHARE := $(PREFIX)/share/waferhand
SHARED := $(filter lua/layouts/% lua/examples/%,$(LUA_SOURCES))

# $(call place,FILE,PLACE): a step of a chain of commands that stops at the first failure
place = install -D -m $(if $(filter %/bin/waferhand,$(2)),755,644) $(1) '$(DESTDIR)$(2)' &&

install: $(B)/waferhand.pc $(B)/waferhand_collision.pc
	@$(foreach to,$(PLACES),$(call place,$(B)/$(notdir $(to)),$(to))) \
	    $(foreach file,$(PUBLIC),$(call place,$(file),$(INCLUDES)/$(file:lib/%=%))) \
	    $(foreach file,$(ENTRIES),$(call place,$(file),$(PREFIX)/include/$(notdir $(file)))) \
	    $(foreach file,$(SHARED),$(call place,$(file),$(SHARE)/$(file:lua/%=%))) \
	    echo 'installed into $(DESTDIR)$(PREFIX)'

$(B)/waferhand.pc $(B)/waferhand_collision.pc: $(B)/%.pc: lib/build/%.pc.in FORCE
	@sed -e 's|@prefix@|$(PREFIX)|' -e 's|@libdir@|$(LIBDIR)|' -e 's|@version@|$(VERSION)|' \
	    -e 's|@defines@|$(if $(FLOAT),-DWH_FLOAT)|' $< >$@

uninstall:
	rm -f $(PLACES:%='$(DESTDIR)%') $(ENTRIES:lib/build/%='$(DESTDIR)$(PREFIX)/include/%')
	rm -rf '$(DESTDIR)$(INCLUDES)' '$(DESTDIR)$(SHARE)'
