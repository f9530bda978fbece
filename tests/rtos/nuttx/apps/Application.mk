# Stands in for apps/Application.mk of NuttX: see Make.defs. Each program of PROGNAME is linked from the MAINSRC of the same place and
# all of CSRCS; flags of a file are those of <path as make found it>_CFLAGS, or of ..._CELFFLAGS where programs are modules.

VPATH += :.
OBJS = $(CSRCS:.c=.o)
ifeq ($(CONFIG_BUILD_KERNEL),y)
compile = $(CC) -c $(CELFFLAGS) $($(strip $<)_CELFFLAGS) $< -o $@
else
compile = $(CC) -c $(CFLAGS) $($(strip $<)_CFLAGS) $< -o $@
endif

all: $(PROGNAME) $(OBJS)
	@test -n "$(PRIORITY)" && test -n "$(STACKSIZE)"

%.o: %.c
	$(compile)

define program
$(word $(1),$(PROGNAME)): $(patsubst %.c,%.o,$(word $(1),$(MAINSRC))) $(OBJS)
	$(CC) $(STAND_IN_CFLAGS) $$^ -o $$@ -lm -lpthread
endef
$(foreach number,$(shell seq $(words $(PROGNAME))),$(eval $(call program,$(number))))
