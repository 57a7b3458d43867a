# Settings that are on or off: 1 is on, 0 or nothing is off, and any other value is refused.
SWITCHES := FLOAT SHARED COLLISION WERROR V JSON
$(foreach switch,$(SWITCHES),$(if $(filter-out undefined,$(origin $(switch))), \
    $(if $(filter-out 0 1,$($(switch))),$(error $(switch)=: 1 or 0, not "$($(switch))")) \
    $(eval override $(switch) := $(filter 1,$($(switch))))))
