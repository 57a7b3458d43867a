# `make bench`: programs that measure. Each peer that is installed gets a shared object of its own beside them, loaded by name.
# So the flags and inline functions of one peer never reach another, and a missing peer affects no other.

BENCH_IN := $(B)/tests/bench
BENCH_SUBJECTS := check index step profile program collide serve
PYPI := build/pypi
# gcc 12 warns inside its own vector headers.
NATIVE := -O3 -march=native -Wno-maybe-uninitialized
comma := ,
PEER_FLAGS := -g -fPIC -shared -fvisibility=hidden -DWH_BUILDING_LIBRARY -Ilib -Itests $(SAME_BITS) -fno-math-errno $(WARNINGS) \
              $(if $(WERROR),-Werror)

# $(call peer,NAME,SOURCE,SPEED,PACKAGES,MORE): if pkg-config knows the packages, or FLAGS say where a wheel is
define peer
ifneq ($(if $(4),$(shell $(PKG_CONFIG) --exists $(4) 2>/dev/null && echo yes),$(firstword $(5))),)
PEERS += $(BENCH_IN)/peer_$(1).so
$(BENCH_IN)/peer_$(1).so: tests/bench/$(2) $(B)/flags
	@mkdir -p $$(@D)
	@echo "  PEER $$@"
	$$(Q)$$(if $$(filter %.c,$(2)),$$(CC) -std=c99,$$(CXX) -std=c++17) $(3) $$(PEER_FLAGS) \
	    $(if $(4),$(patsubst -I%,-isystem %,$(filter -I%,$(shell $(PKG_CONFIG) --cflags $(4) 2>/dev/null)))) -MMD -MP -MF $$@.d \
	    -MT $$@ -o $$@ $$< $(5) $(if $(4),$(shell $(PKG_CONFIG) --libs $(4) 2>/dev/null))
endif
endef

MUJOCO := $(firstword $(wildcard $(PYPI)/mujoco/libmujoco.so.*))
RUCKIG := $(firstword $(wildcard $(PYPI)/lib*/libruckig.a))
$(eval $(call peer,eigen_O2,peer_eigen.cpp,-O2,eigen3))
$(eval $(call peer,eigen_native,peer_eigen.cpp,$(NATIVE),eigen3))
$(eval $(call peer,ccd,peer_ccd.c,-O2,ccd))
$(eval $(call peer,fcl,peer_fcl.cpp,-O2,fcl eigen3))
$(eval $(call peer,fcl_tree,peer_fcl_tree.cpp,-O2,fcl eigen3))
$(eval $(call peer,nanoflann_O2,peer_nanoflann.cpp,-O2 -DBENCH_NAME='"nanoflann O2"',nanoflann))
$(eval $(call peer,nanoflann_native,peer_nanoflann.cpp,$(NATIVE) -DBENCH_NAME='"nanoflann O3n"',nanoflann))
$(eval $(call peer,bullet,peer_bullet.cpp,-O2,bullet))
$(eval $(call peer,mujoco,peer_mujoco.c,-O2,,$(MUJOCO:%=% -Wl$(comma)-rpath$(comma)$(abspath $(PYPI)/mujoco) -isystem $(PYPI)/mujoco/include)))
$(eval $(call peer,ruckig,peer_ruckig.cpp,$(NATIVE),,$(RUCKIG:%=-isystem $(PYPI)/include $(abspath $(RUCKIG)))))

.PHONY: bench
bench: $(BENCH_SUBJECTS:%=$(BENCH_IN)/%) $(BENCH_IN)/counts $(PEERS) program
	@:
-include $(PEERS:%=%.d)

$(BENCH_SUBJECTS:%=$(BENCH_IN)/%): $(B)/obj/tests/bench/harness.o
$(BENCH_SUBJECTS:%=$(BENCH_IN)/%): LIBS = -ldl
# The program reads a recording.
$(BENCH_IN)/collide: $(filter-out $(B)/obj/lib/app/main.o,$(PROGRAM_OBJECTS)) $(B)/libwaferhand_collision.a $(B)/libwaferhand_lcm.a
$(BENCH_IN)/collide: COLLISION = $(COLLISION_LIBS)
$(BENCH_IN)/collide: LIBS = $(PROGRAM_LIBS)
$(B)/obj/tests/bench/collide.o: $(B)/lcm/waferhand_messages.h
